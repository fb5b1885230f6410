"""What `flexspline predict` does: the input's columns, and the predicted angle beside them."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from pathlib import Path

import numpy as np

from flexspline.geometry.design import Design
from flexspline.geometry.errors import one_line
from flexspline.geometry.input_file import InputFileError, read_input
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.table import LARGEST_BYTES
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
) -> str:
    """Predict, write prediction.csv, and return what is printed.

    Raises
    ------
    ModelFileError, MeasurementError
    """
    file = read_model_file(model)
    predicted = predict_file(file, torque)
    if file.provenance.design != design.name:
        tell(
            f"warning: the model is of {one_line(file.provenance.design)}, "
            f"not of {one_line(design.name)}"
        )
    for line in predicted.warnings:
        tell(f"warning: {one_line(line)}")
    angle = predicted.angle_arcsec
    write_bytes(folder / PREDICTION, with_column(torque, angle).encode())
    if json:
        return as_json({"angle_arcsec": angle.tolist()})
    return (
        f"{len(angle)} rows, {angle.min():.6g} to {angle.max():.6g} arcsec\n{folder / PREDICTION}"
    )


def with_column(path: Path, angle_arcsec: np.ndarray) -> str:
    """The file's rows as they stand, comments left out, with the predicted angle as last column.

    A column of that name, from an earlier prediction, is replaced.
    """
    try:
        text = read_input(path, LARGEST_BYTES, "a measured file").decode("utf-8-sig")
    except InputFileError as error:  # it was there a moment ago
        raise MeasurementError(path, None, str(error)) from None
    kept = [s for s in text.splitlines() if s.strip() and not s.lstrip().startswith("#")]
    rows = list(csv.reader(kept))
    at = [i for i, name in enumerate(rows[0]) if name.strip() != COLUMN]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*(rows[0][i] for i in at), COLUMN])
    for row, angle in zip(rows[1:], angle_arcsec, strict=True):
        writer.writerow([*(row[i] for i in at), f"{angle:.6f}"])
    return out.getvalue()
