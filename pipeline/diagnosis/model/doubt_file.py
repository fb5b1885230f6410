"""The uncertainty of predictions, as written in extended_model.toml."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from flexspline.pipeline.diagnosis.measurement.floors import ROUNDING_OF_SUMS
from flexspline.pipeline.diagnosis.measurement.table import LARGEST_NUMBER
from flexspline.pipeline.diagnosis.model.doubt import PredictionUncertainty, parameter_count
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.model_keys import (
    DOUBT,
    DOUBT_OPTIONAL,
    MEASURED,
    MEASURED_OPTIONAL,
    Refuse,
    check,
    is_number,
)
from flexspline.pipeline.diagnosis.model.span import Ends, MeasuredSpan

ABOUT = """\
[doubt]   # one standard deviation of a reading from its prediction
reading_arcsec = {reading}   # largest of: rms error on rows not fitted, noise, an encoder's rounding
torque_noise_Nm = {noise}
crossing_Nm = {crossing}   # over which the record's rows lie in the gap or beyond it, beside the noise
# covariance of zeros, compliance, gap, each unit's own compliance and gap, and all amplitudes below, in the
# order of this file; lower triangle
covariance = ["""

POSITIVE = ("smallest_loop_Nm", "rate_Nm_per_s", "slowest_rate_Nm_per_s")
"""Numbers of [doubt.measured] that may be absent."""


def doubt_lines(doubt: PredictionUncertainty) -> list[str]:
    """Lines of the table [doubt]."""
    numbers = {
        "reading": doubt.reading_arcsec,
        "noise": doubt.torque_noise_Nm,
        "crossing": doubt.crossing_Nm,
    }
    lines = [ABOUT.format(**{name: repr(value) for name, value in numbers.items()})]
    lines += [
        f"  [{', '.join(repr(float(v)) for v in row[: i + 1])}],"
        for i, row in enumerate(doubt.covariance)
    ]
    lines += ["]", "[doubt.measured]   # beyond these, predictions extrapolate"]
    span = doubt.span
    lines.append(f"torque_Nm = {_pair(span.torque_Nm)}")
    for name in POSITIVE:
        value = getattr(span, name)
        if value is not None:
            lines.append(f"{name} = {value!r}")
    for name in ("temperature_C", "input_angle_deg"):
        ends = getattr(span, name)
        if ends is not None:
            lines.append(f"{name} = {_pair(ends)}")
    return [*lines, ""]


def read_doubt(
    table: Mapping[str, Any], model: ExtendedModel, refuse: Refuse
) -> PredictionUncertainty:
    """The table [doubt] of a file, checked against its model.

    Raises
    ------
    ModelFileError : unknown or missing keys, no covariance, or not the model's.
    """
    check(table, DOUBT, DOUBT_OPTIONAL, "[doubt]", refuse)
    measured = table["measured"]
    check(measured, MEASURED, MEASURED_OPTIONAL, "[doubt.measured]", refuse)
    for key in ("reading_arcsec", "torque_noise_Nm", "crossing_Nm"):
        if table.get(key, 0.0) < 0:
            raise refuse(f"{key} in [doubt] must not be negative")
    covariance = _covariance(table["covariance"], refuse)
    if len(covariance) not in (0, parameter_count(model)):
        raise refuse(
            f"covariance in [doubt] is of {len(covariance)} parameters; the model has "
            f"{parameter_count(model)}"
        )
    ends = {
        key: _ends(measured[key], key, refuse)
        for key in ("torque_Nm", "temperature_C", "input_angle_deg")
        if key in measured
    }
    for key in POSITIVE:
        if key in measured and measured[key] <= 0:
            raise refuse(f"{key} in [doubt.measured] must be above 0")
    smallest, fastest, slowest = (float(measured[k]) if k in measured else None for k in POSITIVE)
    span = MeasuredSpan(
        **ends,
        smallest_loop_Nm=smallest,
        rate_Nm_per_s=fastest,
        slowest_rate_Nm_per_s=slowest,
    )
    return PredictionUncertainty(
        float(table["reading_arcsec"]),
        float(table["torque_noise_Nm"]),
        covariance,
        span,
        float(table.get("crossing_Nm", 0.0)),
    )


def _covariance(rows: list[Any], refuse: Refuse) -> np.ndarray:
    covariance = np.zeros((len(rows), len(rows)))
    for i, row in enumerate(rows):
        if not isinstance(row, list) or len(row) != i + 1 or not all(map(is_number, row)):
            many = "1 number" if i == 0 else f"{i + 1} numbers"
            raise refuse(
                f"row {i + 1} of covariance in [doubt] must be {many}, each within ±{LARGEST_NUMBER:g}"
            )
        covariance[i, : i + 1] = row
    covariance += np.tril(covariance, -1).T
    if (
        len(covariance)
        and np.linalg.eigvalsh(covariance)[0]
        < -ROUNDING_OF_SUMS * np.abs(np.diag(covariance)).max()
    ):
        raise refuse(
            "covariance in [doubt] must give every combination of parameters a variance above 0"
        )
    return covariance


def _ends(values: list[Any], name: str, refuse: Refuse) -> Ends:
    if len(values) != 2 or not all(map(is_number, values)) or values[0] > values[1]:
        raise refuse(f"{name} in [doubt.measured] must be two numbers, the smaller first")
    return float(values[0]), float(values[1])


def _pair(ends: Ends) -> str:
    return f"[{ends[0]!r}, {ends[1]!r}]"
