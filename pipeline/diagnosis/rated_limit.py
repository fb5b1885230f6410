"""Torques of a recommended measurement: at most the rated torque, or the record's own largest torque."""

from __future__ import annotations

from collections.abc import Iterable

WORTH_SHARE = 1.05
"""Rated torque over the next smaller torque, from which rated torque is listed separately. Judgement."""
FIGURES = 3
"""Significant figures of a torque that a person sets."""


def within_rated(
    torques_Nm: Iterable[float], measured_Nm: float, rated_Nm: float | None
) -> tuple[float, ...]:
    """Torques wished for, in rising order, those beyond rated torque replaced by it.

    `measured_Nm`: the largest of the record, which is asked for again in any case.
    """
    wished = sorted(float(f"{t:.{FIGURES}g}") for t in torques_Nm)
    if rated_Nm is None:
        return tuple(wished)
    most = max(rated_Nm, float(f"{measured_Nm:.{FIGURES}g}"))
    kept = [t for t in wished if t <= most]
    if len(kept) < len(wished) and rated_Nm > WORTH_SHARE * max(kept, default=0.0):
        kept.append(rated_Nm)
    return tuple(kept)
