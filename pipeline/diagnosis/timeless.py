"""A record without time: the computation uses rows as seconds, and results must say rows."""

from __future__ import annotations

from dataclasses import replace

from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome, NextMeasurement

PER_SECOND, PER_ROW = "N·m/s", "N·m/row"
TIME, ROW = "time_s", "row"
"""The channel that such a record lacks, and the one that it has in its place."""


def in_rows(outcome: DiagnosisOutcome) -> DiagnosisOutcome:
    """The outcome with rates per row in place of per second, and structure over rows in place of time."""
    causes = (replace(c, unit=c.unit.replace(PER_SECOND, PER_ROW)) for c in outcome.causes)
    unexplained = (replace(u, channel=over_rows(u.channel)) for u in outcome.unexplained)
    return replace(
        outcome,
        causes=tuple(causes),
        unexplained=tuple(unexplained),
        next_measurement=_next(outcome.next_measurement),
    )


def over_rows(channel: str) -> str:
    """The channel that stands for `channel` where time was not recorded."""
    return ROW if channel == TIME else channel


def _next(after: NextMeasurement | None) -> NextMeasurement | None:
    """The measurement for what is still unknown; one that distinguishes named causes may need time."""
    if after is None or after.aim != "find_structure":
        return after
    return replace(after, vary=over_rows(after.vary))
