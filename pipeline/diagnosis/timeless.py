"""Units of a record without time: rows stand for seconds in the computation, and must not be called so."""

from __future__ import annotations

from dataclasses import replace

from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome

PER_SECOND, PER_ROW = "N·m/s", "N·m/row"


def per_row(outcome: DiagnosisOutcome) -> DiagnosisOutcome:
    """The outcome with rates per row in place of per second."""
    causes = (replace(c, unit=c.unit.replace(PER_SECOND, PER_ROW)) for c in outcome.causes)
    return replace(outcome, causes=tuple(causes))
