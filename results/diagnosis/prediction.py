"""What `flexspline predict` does: the input's columns, and the predicted angle beside them."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from pathlib import Path

import numpy as np

from flexspline.geometry.design import Design
from flexspline.geometry.errors import one_line
from flexspline.pipeline.diagnosis.measurement.grid import read_grid
from flexspline.pipeline.diagnosis.model.model_file import read_model_file
from flexspline.pipeline.diagnosis.model.predict import predict_file
from flexspline.results.atomic import write_bytes
from flexspline.results.records import as_json

PREDICTION = "prediction.csv"
COLUMN = "angle_predicted_arcsec"


def predict_and_write(
    design: Design,
    model: Path,
    torque: Path,
    folder: Path,
    json: bool,
    tell: Callable[[str], None],
    counts_per_turn: float | None = None,
) -> str:
    """Predict, write prediction.csv, and return what is printed.

    Raises
    ------
    ModelFileError, MeasurementError
    """
    file = read_model_file(model)
    predicted = predict_file(file, torque, counts_per_turn)
    if file.provenance.design != design.name:
        tell(
            f"warning: the model is of {one_line(file.provenance.design)}, "
            f"not of {one_line(design.name)}"
        )
    for line in predicted.warnings:
        tell(f"warning: {one_line(line)}")
    angle = predicted.angle_arcsec
    write_bytes(
        folder / PREDICTION, with_column(torque, angle, predicted.read_as.decimal_mark).encode()
    )
    if json:
        return as_json({"angle_arcsec": angle.tolist()})
    return (
        f"{len(angle)} rows, {angle.min():.6g} to {angle.max():.6g} arcsec\n{folder / PREDICTION}"
    )


def with_column(path: Path, angle_arcsec: np.ndarray, decimal_mark: str = ".") -> str:
    """The file's rows as they stand, comments left out, with the predicted angle as last column.

    Separator, decimal mark and row of units stay the file's own; a workbook's sheet is written with commas
    and points. A column of that name, from an earlier prediction, is replaced.
    """
    table = read_grid(path)  # it was there a moment ago
    separator = table.separator or ","
    comma = separator != "," and decimal_mark == ","
    at = [i for i, name in enumerate(table.head) if name != COLUMN]
    out = io.StringIO()
    writer = csv.writer(out, delimiter=separator, lineterminator="\n")
    writer.writerow([*(table.head[i] for i in at), COLUMN])
    if table.unit_row:
        writer.writerow([*(table.unit_row[i] for i in at), "arcsec"])
    for row, angle in zip(table.rows, angle_arcsec, strict=True):
        text = f"{angle:.6f}"
        writer.writerow([*(row[i] for i in at), text.replace(".", ",") if comma else text])
    return out.getvalue()
