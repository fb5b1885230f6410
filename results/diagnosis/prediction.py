"""Steps of `flexspline predict`: the input's columns with the predicted angle and its deviation."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from flexspline.geometry.design import Design
from flexspline.geometry.errors import one_line
from flexspline.pipeline.diagnosis.measurement.grid import read_grid
from flexspline.pipeline.diagnosis.model.model_file import read_model_file
from flexspline.pipeline.diagnosis.model.predict import predict_file
from flexspline.results.atomic import write_bytes
from flexspline.results.diagnosis.model_notes import model_warnings
from flexspline.results.diagnosis.prediction_words import prediction_warnings
from flexspline.results.file_names import PREDICTION
from flexspline.results.job import tell
from flexspline.results.records import as_json

COLUMN, STD_COLUMN = "angle_predicted_arcsec", "angle_std_arcsec"


def predict_and_write(
    design: Design,
    model: Path,
    torque: Path,
    folder: Path,
    json: bool,
    counts_per_turn: float | None = None,
) -> str:
    """Predict, write prediction.csv, and return what is printed.

    Raises
    ------
    ModelFileError, MeasurementError
    """
    file = read_model_file(model)
    predicted = predict_file(file, torque, counts_per_turn)
    for line in (*model_warnings(file, design), *prediction_warnings(predicted)):
        tell(f"warning: {one_line(line)}")
    if predicted.angle_std_arcsec is None:
        tell(
            "note: no standard deviations are given, and rows beyond the measured torques are not counted: "
            "only a model from a torque sweep contains these data"
        )
    angle, std = predicted.angle_arcsec, predicted.angle_std_arcsec
    added = {COLUMN: angle} | ({STD_COLUMN: std} if std is not None else {})
    text = with_columns(torque, added, predicted.read_as.decimal_mark)
    write_bytes(folder / PREDICTION, text.encode())
    if json:
        record = {"angle_arcsec": angle.tolist()}
        return as_json(record | ({"angle_std_arcsec": std.tolist()} if std is not None else {}))
    off = "" if std is None else f", ± {std.min():.3g} to {std.max():.3g} (one standard deviation)"
    summary = f"{len(angle)} row{'s' * (len(angle) != 1)}, {angle.min():.6g} to {angle.max():.6g} arcsec{off}"
    return f"{summary}\n{folder / PREDICTION}"


def with_columns(
    path: Path, added_arcsec: Mapping[str, np.ndarray], decimal_mark: str = "."
) -> str:
    """The file's rows as they stand, comments left out, with further columns (n,) at their end.

    Separator, decimal mark and row of units stay the file's own; a workbook's sheet is written with commas
    and points. Columns of an earlier prediction are replaced.
    """
    table = read_grid(path)  # it was there a moment ago
    separator = table.separator or ","
    comma = separator != "," and decimal_mark == ","
    at = [i for i, name in enumerate(table.head) if name not in (COLUMN, STD_COLUMN)]
    out = io.StringIO()
    writer = csv.writer(out, delimiter=separator, lineterminator="\n")
    writer.writerow([*(table.head[i] for i in at), *added_arcsec])
    if table.unit_row:
        writer.writerow([*(table.unit_row[i] for i in at), *("arcsec" for _ in added_arcsec)])
    for row, *values in zip(table.rows, *added_arcsec.values(), strict=True):
        texts = [f"{value:.6f}" for value in values]
        writer.writerow(
            [*(row[i] for i in at), *(t.replace(".", ",") if comma else t for t in texts)]
        )
    return out.getvalue()
