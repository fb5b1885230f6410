"""Which rows of a history lie beyond what a model's record spans, in words."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.model.doubt import Deviation
from flexspline.pipeline.diagnosis.model.span import MeasuredSpan, span_of
from flexspline.pipeline.diagnosis.timeless import PER_ROW, PER_SECOND


def extrapolated(
    deviation: Deviation, span: MeasuredSpan, history: History, timed: bool = True
) -> list[str]:
    """A line for each channel in which rows lie outside; their deviations are wider.

    `timed`: whether the model's record had time; without, a row counts as a second.
    """
    if not deviation.rows_beyond:
        return []
    own, rate = span_of(history), PER_SECOND if timed else PER_ROW
    return [
        f"{count} of {len(history)} rows extrapolate: {_reach(channel, own, rate)}; the model's record "
        f"{_reach(channel, span, rate)}; their deviations are wider"
        for channel, count in deviation.rows_beyond.items()
    ]


def _reach(channel: str, span: MeasuredSpan, rate: str) -> str:
    if channel == "torque_amplitude":
        return f"has a cycle that reaches only {span.smallest_loop_Nm or 0.0:.4g} N·m"
    if channel == "torque_rate":
        return f"torque moves by {span.rate_Nm_per_s or 0.0:.3g} {rate}"
    names = {
        "torque_Nm": ("torque {} to {} N·m", span.torque_Nm),
        "temperature_C": ("temperature {} to {} °C", span.temperature_C),
        "input_angle_deg": ("wave generator at {} to {}°", span.input_angle_deg),
    }
    words, ends = names[channel]
    return words.format(*(f"{e:.4g}" for e in ends or (np.nan, np.nan)))
