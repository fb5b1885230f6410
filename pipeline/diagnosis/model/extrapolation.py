"""Which rows of a history lie beyond what a model's record spans, in words."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.model.doubt import Deviation
from flexspline.pipeline.diagnosis.model.span import Ends, MeasuredSpan, span_of
from flexspline.pipeline.diagnosis.timeless import PER_ROW, PER_SECOND

LESS_CERTAIN = "the model is less certain there"
SPANS = {
    "torque_Nm": ("torque", " N·m"),
    "temperature_C": ("temperature", " °C"),
    "input_angle_deg": ("positions of the wave generator", "°"),
}
"""Channels with two ends: what they are called, and their unit."""


def extrapolated(
    deviation: Deviation, span: MeasuredSpan, history: History, timed: bool = True
) -> list[str]:
    """A sentence for each channel in which rows lie outside: what they are, this file, the record, and why
    their deviations are wider.

    `timed`: whether the model's record had time; without, a row counts as a second.
    """
    own, rate = span_of(history), PER_SECOND if timed else PER_ROW
    return [
        f"{count} of {len(history)} rows {_outside(channel, own, span, rate)}, so their deviations are wider"
        for channel, count in deviation.rows_beyond.items()
    ]


def _outside(channel: str, own: MeasuredSpan, record: MeasuredSpan, rate: str) -> str:
    if channel == "torque_amplitude":
        here, there = (f"{s.smallest_loop_Nm or 0.0:.4g} N·m" for s in (own, record))
        return (
            f"are in cycles smaller than the smallest measured: the smallest of this file reaches {here}, "
            f"that of the model's record {there}; the friction of small loops is less certain"
        )
    if channel == "torque_rate":
        here, there = (f"{s.rate_Nm_per_s or 0.0:.3g} {rate}" for s in (own, record))
        return (
            f"are faster than measured: torque in this file moves by {here}, in the model's record by "
            f"{there}; {LESS_CERTAIN}"
        )
    if channel == "slow_torque_rate":
        here, there = (f"{s.slowest_rate_Nm_per_s or 0.0:.3g} {rate}" for s in (own, record))
        return (
            f"are slower than measured: torque in this file moves by as little as {here}, in the model's "
            f"record by {there} or more; what of the model is rate dependence is less certain there"
        )
    words, unit = SPANS[channel]
    here, there = (_ends(getattr(s, channel), unit) for s in (own, record))
    return (
        f"are beyond the measured {words}: this file spans {here}, the model's record {there}; "
        f"{LESS_CERTAIN}"
    )


def _ends(ends: Ends | None, unit: str) -> str:
    low, high = ends or (np.nan, np.nan)
    return f"{low:.4g} to {high:.4g}{unit}"
