"""Specimens that agree only where a dimension is off within its tolerance: which, and what else would fit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flexspline.results.diagnosis.words import plus_minus

if TYPE_CHECKING:
    from flexspline.pipeline.diagnosis.specimens.finding import SpecimenAnalysis
    from flexspline.pipeline.diagnosis.specimens.sensitivity import Sensitivity


def within_tolerance(analysis: SpecimenAnalysis) -> list[tuple[Sensitivity, float]]:
    """Dimensions that the fit moves within their tolerances, with by how much [mm]."""
    chosen = analysis.chosen
    return [
        (term.sensitivity, float(value))
        for term, value in zip(chosen.terms, chosen.mean[1:], strict=True)
        if term.sensitivity is not None and term.owner not in chosen.causes
    ]


def needed_tolerance(analysis: SpecimenAnalysis) -> list[tuple[Sensitivity, float]]:
    """Those without which the specimens would not agree; the modulus alone then explains less."""
    # here: it loads the solvers, which a diagnosis with given stiffnesses does without
    from flexspline.pipeline.diagnosis.specimens.decide import OVER_NULL_NATS

    gain = analysis.chosen.score - analysis.race.null_fit.score
    return within_tolerance(analysis) if gain > OVER_NULL_NATS else []


def only_because(analysis: SpecimenAnalysis) -> str:
    """What the agreement rests on, as the end of a sentence; "" where it is the stated uncertainty's."""
    if not (needed := needed_tolerance(analysis)):
        return ""
    which = " and ".join(f"{s.key} may be off by ± {s.tolerance_mm:g} mm" for s, _ in needed)
    return (
        f"only because {which} (general tolerance ISO 2768-m, assumed and not stated in the design)"
    )


def modulus_alone(analysis: SpecimenAnalysis) -> str:
    """What the modulus would have to be if no dimension were off; "" where no dimension is needed."""
    if not needed_tolerance(analysis):
        return ""
    alone, stated = analysis.race.null_fit, analysis.race.data.modulus_std
    change = plus_minus(100 * alone.mean[0], 100 * float(alone.covariance[0, 0] ** 0.5))
    text = f"with every dimension as drawn Young's modulus would have to differ by {change} %"
    if stated:
        text += f", {abs(float(alone.mean[0])) / stated:.1f} of its stated standard deviations"
    return text
