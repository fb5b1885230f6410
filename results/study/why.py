"""Reasons why the best designs are best, in sentences with numbers."""

from __future__ import annotations

from flexspline.geometry.listed import joined, listed
from flexspline.pipeline.study.holes import unfollowed as unfollowed_keys
from flexspline.pipeline.study.influence import (
    OpenEnd,
    binding,
    open_ends,
    own_influences,
    unbuilt_neighbours,
)
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.schema import Limit
from flexspline.pipeline.study.study import Study
from flexspline.pipeline.study.verified import STRESS_SHARE, Check
from flexspline.results.numbers import signed
from flexspline.results.study.labels import LISTED_DESIGNS, entry, valued

STRONG_CORRELATION = 0.3
"""Rank correlation from which an influence is worth a sentence."""


def influences(result: StudyResult) -> list[str]:
    """What moves each objective."""
    sentences = []
    for figure, correlations in own_influences(result).items():
        strong = [
            f"{'rises' if i.correlation > 0 else 'falls'} with {entry(i.key).name} "
            f"(rank correlation {signed(i.correlation)})"
            for i in correlations
            if abs(i.correlation) >= STRONG_CORRELATION
        ]
        follows = ", ".join(strong) or "follows no single dimension"
        sentences.append(f"{entry(figure).name} {follows}.")
    return sentences


def misses(result: StudyResult) -> list[str]:
    """If no design meets every constraint: how many meet each, and the nearest one."""
    row = result.nearest
    if row is None or result.feasible:
        return []
    sentences = []
    for key, limit in result.study.file.constraint.items():
        q = entry(key)
        kept = len(result.keeping(key))
        constraint = allowed(key, limit)
        sentences.append(
            f"{q.name}: {kept} of {len(result.built)} designs meet {constraint}; the nearest to all "
            f"constraints, design {row.slot}, has {valued(key, row.outcome.figures)}."
        )
    at = ", ".join(f"{entry(k).name} {entry(k).with_unit(v)}" for k, v in row.values.items())
    return [*sentences, f"Design {row.slot}: {at}."]


def allowed(key: str, limit: Limit) -> str:
    """What a constraint allows, in words: at least, at most."""
    q = entry(key)
    ends = ((limit.min, "at least"), (limit.max, "at most"))
    return joined((f"{word} {q.with_unit(end)}" for end, word in ends if end is not None), "and")


def limits(result: StudyResult) -> list[str]:
    """Spans, constraints and designs that could not be built, which hold the best design back."""
    sentences = _open_ends(result)
    for best in result.pareto[:1]:
        for key in binding(result, best):
            q = entry(key)
            sentences.append(
                f"Design {best.slot} is limited by the constraint on {q.name}: "
                f"{q.with_unit(best.outcome.figures[key])}, allowed: "
                f"{allowed(key, result.study.file.constraint[key])}."
            )
        for key, value in unbuilt_neighbours(result, best):
            q = entry(key)
            sentences.append(
                f"Next to design {best.slot}, the next {q.name} of the grid, {q.with_unit(value)}, could not "
                "be built or solved."
            )
    return sentences


def _open_ends(result: StudyResult) -> list[str]:
    """Ends of spans at which the best design lies, of several objectives those in the table."""
    at_end: dict[OpenEnd, list[str]] = {}
    one = len(result.study.file.objective) == 1
    for best in result.pareto[:1] if one else result.best(LISTED_DESIGNS):
        for end in open_ends(result, best):
            at_end.setdefault(end, []).append(str(best.slot))
    sentences = []
    for end, slots in at_end.items():
        q, many = entry(end.key), len(slots) > 1
        who = f"Designs {listed(slots, 'designs')} lie" if many else f"Design {slots[0]} lies"
        sentences.append(
            f"{who} at the {end.end} end of the range of {q.name} ({q.with_unit(end.value)}): a wider "
            "range may contain a better design."
        )
    return sentences


def disagreement(check: Check) -> str:
    """Why the fast and the solid model may differ by more than they should."""
    if check.fast_bounds and check.solid_bounds:
        return (
            "the two models differ by more than their bounds; the fast model takes the effect of the shaft's "
            "holes from the nominal design"
        )
    return (
        f"the two models differ by more than {100 * STRESS_SHARE:g} %; neither has bounds: the fast model "
        "has a finer mesh, and only the solid model contains holes near the peak"
    )


def unfollowed(study: Study) -> str:
    """Keys of the shaft's holes and keyway that the study changes; "" where there are none."""
    return ", ".join(unfollowed_keys(study.keys))


def incomplete(result: StudyResult) -> str:
    """How many designs lack a figure that neither objective nor constraint asks for."""
    count = len(result.incomplete)
    lack = "1 design lacks" if count == 1 else f"{count} designs lack"
    return f"{lack} a figure that the study does not need (column reason)"
