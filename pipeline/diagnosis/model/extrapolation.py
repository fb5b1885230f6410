"""Rows of a history that lie outside the range of the model's record."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.model.doubt import Deviation
from flexspline.pipeline.diagnosis.model.span import Ends, MeasuredSpan, span_of

LIMITS = {
    "torque_amplitude": "smallest_loop_Nm",
    "torque_rate": "rate_Nm_per_s",
    "slow_torque_rate": "slowest_rate_Nm_per_s",
}
"""Channels that are left at one end, with the field of a span that says it."""


@dataclass(frozen=True)
class RowsBeyond:
    """Rows that lie outside of what a model's record spans, whose deviations are therefore wider.

    Attributes
    ----------
    channel : in which they do. count : of the history's `rows`.
    here, there : what this history spans, and the record: two ends, or the one limit of a channel of
        `LIMITS`; None where it has none.
    timed : whether the record had time; without, a row counts as a second.
    """

    channel: str
    count: int
    rows: int
    here: Ends | float | None
    there: Ends | float | None
    timed: bool


def extrapolated(
    deviation: Deviation, span: MeasuredSpan, history: History, timed: bool = True
) -> Iterator[RowsBeyond]:
    """The rows outside, by channel; `timed` as `RowsBeyond` has it."""
    own = span_of(history)
    for channel, count in deviation.rows_beyond.items():
        here, there = (getattr(s, LIMITS.get(channel, channel)) for s in (own, span))
        yield RowsBeyond(channel, count, len(history), here, there, timed)
