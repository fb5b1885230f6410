"""Warnings of a prediction: units and rows that the model's record does not have."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from flexspline.geometry.listed import listed
from flexspline.pipeline.diagnosis.model.extrapolation import RowsBeyond
from flexspline.pipeline.diagnosis.model.predict import Predicted
from flexspline.pipeline.diagnosis.timeless import PER_ROW, PER_SECOND

LESS_CERTAIN = "the model is less certain there"
SPANS = {
    "torque_Nm": ("torque", " N·m"),
    "temperature_C": ("temperature", " °C"),
    "input_angle_deg": ("positions of the wave generator", "°"),
}
"""Channels with two ends: what they are called, and their unit."""


def prediction_warnings(predicted: Predicted) -> Iterator[str]:
    """One line each."""
    if new := predicted.new_units:
        units = f"unit {listed(new, 'units')}" if any(new) else "a file without units"
        yield (
            f"{units}: not in the model, so its zero offset is taken as 0, and effects of this unit alone "
            "are not known"
        )
    yield from map(beyond_words, predicted.beyond)


def beyond_words(rows: RowsBeyond) -> str:
    """Which rows lie outside the record, what this file and the record span, and that they are less sure."""
    return f"{rows.count} of {rows.rows} rows {_outside(rows)}, so their standard deviations are larger"


def _outside(rows: RowsBeyond) -> str:
    rate = PER_SECOND if rows.timed else PER_ROW
    if rows.channel == "torque_amplitude":
        in_file, in_record = (f"{_limit(s):.4g} N·m" for s in (rows.here, rows.there))
        return (
            f"are in cycles smaller than measured: the smallest cycle reaches {in_file} in this file and "
            f"{in_record} in the model's record; the friction of small loops is less certain"
        )
    if rows.channel == "torque_rate":
        in_file, in_record = (f"{_limit(s):.3g} {rate}" for s in (rows.here, rows.there))
        return (
            f"are faster than measured: torque in this file moves by {in_file}, in the model's record by "
            f"{in_record}; {LESS_CERTAIN}"
        )
    if rows.channel == "slow_torque_rate":
        in_file, in_record = (f"{_limit(s):.3g} {rate}" for s in (rows.here, rows.there))
        return (
            f"are slower than measured: torque in this file moves by as little as {in_file}, in the model's "
            f"record by {in_record} or more; the model's rate dependence is less certain there"
        )
    words, unit = SPANS[rows.channel]
    in_file, in_record = (
        f"{low:.4g} to {high:.4g}{unit}" for low, high in map(_ends, (rows.here, rows.there))
    )
    return (
        f"are beyond the measured {words}: this file spans {in_file}, the model's record {in_record}; "
        f"{LESS_CERTAIN}"
    )


def _limit(span: tuple[float, float] | float | None) -> float:
    return 0.0 if span is None or isinstance(span, tuple) else span


def _ends(span: tuple[float, float] | float | None) -> tuple[float, float]:
    return span if isinstance(span, tuple) else (np.nan, np.nan)
