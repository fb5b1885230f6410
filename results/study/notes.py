"""What a study's report says about its own limits."""

from __future__ import annotations

from collections.abc import Iterable

from pipeline.study.evaluate import LOBE_TOLERANCE, TORSION_TOLERANCE
from pipeline.study.holes import DRIFT, pierced
from pipeline.study.mass import DENSITY_KG_M3
from pipeline.study.result import StudyResult
from results.study.why import signed, unfollowed


def notes(result: StudyResult) -> list[str]:
    """Sentences of the section "What holds"."""
    said = [
        f"Fast model: the axisymmetric one of the same meridian, without bolt holes and keyway; there K "
        f"is between bounds at most {100 * TORSION_TOLERANCE:g} % apart, lobes "
        f"{100 * LOBE_TOLERANCE:g} %.",
        *_holes(result),
        f"Mass at {DENSITY_KG_M3:g} kg/m³ (steel), since the design file has no density.",
    ]
    if not result.verified:
        said.append("No design was solved again with the solid model (run.verify = 0).")
    return said


def _holes(result: StudyResult) -> Iterable[str]:
    """How K_b and K_e were corrected for holes and keyway, and what that does to their bounds."""
    pierced_ones = pierced(result.study.design)
    factors = {
        k: next((r.outcome.figures[f] for r in result.built if f in r.outcome.figures), None)
        for k, f in ((k, f"{k}_holes_factor") for k in pierced_ones)
    }
    used = {k: f for k, f in factors.items() if f is not None}
    if used:
        said = " and ".join(f"{k} by {_percent(100 * (f - 1))}" for k, f in used.items())
        yield (
            f"Holes and keyway change {said} in the design that the study began with (one solid solve). "
            "Every design's K is corrected by that; its bounds are widened by what both solves leave open "
            f"and by {100 * DRIFT:g} % of the correction, and are estimates. Lobes and stresses are not "
            "corrected."
        )
    if missing := [k for k in pierced_ones if k not in used]:
        yield (
            f"{' and '.join(missing)}: of the part without its holes or keyway, since the solid solve "
            "that would tell their effect failed."
        )
    if keys := unfollowed(result.study):
        yield f"{keys}: the fast model does not follow these; mass does, and run.verify solves them."


def _percent(value: float) -> str:
    return f"{signed(value, 1)} %" if abs(value) >= 0.05 else "less than 0.05 %"
