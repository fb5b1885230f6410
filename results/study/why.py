"""Why the best designs win, in sentences with numbers."""

from __future__ import annotations

import numpy as np

from flexspline.geometry.ranges import SMALLEST_NUMBER
from flexspline.pipeline.study.holes import unfollowed as unfollowed_keys
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.schema import Limit
from flexspline.pipeline.study.study import Study
from flexspline.pipeline.study.verified import STRESS_SHARE, Check
from flexspline.results.numbers import signed
from flexspline.results.study.labels import entry, valued

STRONG = 0.3
"""Rank correlation from which an influence is worth a sentence."""
BY_CHANCE = 0.01
"""Of dimensions that move nothing, the share that a report may say something of."""
SAME = 1e-9
"""Of ranks that others make up to rounding."""
AT_END = 0.02
"""Of a span: a best design so near its end would go on if it could."""
FEWEST_RANKED_ROWS = 8
"""Rows from which a rank correlation says something, and beyond the dimensions a plane."""
WORTH_DEVIATIONS = 0.1
"""Standard deviations of a figure across a whole span: less is no influence that is worth a word."""


def influences(result: StudyResult) -> list[str]:
    """What moves each objective, by Spearman's rank correlation over all designs built.

    An optimiser's designs move several dimensions together, and few designs agree by chance: what is no
    influence of the dimension itself is left out.
    """
    rows = result.built
    if len(rows) < FEWEST_RANKED_ROWS or result.about_scatter:  # where indices say what moves what
        return []
    said = []
    values = {key: np.array([r.values[key] for r in rows]) for key in result.study.file.vary}
    moved = {key: x for key, x in values.items() if np.ptp(x) > 0}
    for key in result.shown:
        y = np.array([r.outcome.figures[key] for r in rows])
        found = []
        for varied, x in moved.items():
            others = [moved[other] for other in moved if other != varied]
            if np.ptp(y) > 0 and _is_its_own(x, y, others):
                found.append((_spearman(x, y), entry(varied).name))
        found.sort(key=lambda f: -abs(f[0]))
        strong = [
            f"{'rises' if rho > 0 else 'falls'} with {name} (rank correlation {signed(rho)})"
            for rho, name in found
            if abs(rho) >= STRONG
        ]
        title = entry(key).name
        said.append(f"{title} {', '.join(strong) if strong else 'follows no single dimension'}.")
    return said


def misses(result: StudyResult) -> list[str]:
    """Where no design keeps to every constraint: how many keep to each, and the nearest one."""
    row = result.nearest
    if row is None or result.feasible:
        return []
    said = []
    for key, limit in result.study.file.constraint.items():
        q = entry(key)
        kept = sum(limit.excess(r.outcome.figures[key]) <= 0 for r in result.built)
        asked = allowed(key, limit)
        said.append(
            f"{q.name}: {kept} of {len(result.built)} designs keep to {asked}; the nearest to all "
            f"constraints, design {row.slot}, has {valued(key, row.outcome.figures)}."
        )
    at = ", ".join(f"{entry(k).name} {entry(k).with_unit(v)}" for k, v in row.values.items())
    return [*said, f"Design {row.slot}: {at}."]


def allowed(key: str, limit: Limit) -> str:
    """What a constraint allows, in words: at least, at most."""
    q = entry(key)
    ends = ((limit.min, "at least"), (limit.max, "at most"))
    return " and ".join(f"{word} {q.with_unit(end)}" for end, word in ends if end is not None)


def limits(result: StudyResult) -> list[str]:
    """Spans and constraints that hold the best design back."""
    if not result.pareto:
        return []
    best, file = result.pareto[0], result.study.file
    said = []
    for key, span in file.vary.items():
        low, high = span.ends
        reach = AT_END * (high - low)
        for end, name in ((low, "lower"), (high, "upper")):
            outward = 1 if end == high else -1
            if abs(best.values[key] - end) <= reach and _may_help(result, key, outward):
                q = entry(key)
                said.append(
                    f"Design {best.slot} lies at the {name} end of its span in {q.name} "
                    f"({q.with_unit(end)}): a wider span may hold a better one."
                )
    for key, limit in file.constraint.items():
        value = best.outcome.figures[key]
        if _holds(limit, value):
            q = entry(key)
            said.append(
                f"Design {best.slot} is held by the constraint on {q.name}: {q.with_unit(value)}, allowed "
                f"are {allowed(key, limit)}."
            )
    return said


def _may_help(result: StudyResult, key: str, outward: int) -> bool:
    """Whether a wider span may hold a better design: an objective gains that way, or a constraint eases.

    By the slopes of a plane through all designs built, every dimension in its span's width and every figure
    in its scatter. True where they are too few for a plane.
    """
    rows, file = result.built, result.study.file
    keys = list(file.vary)
    if len(rows) < len(keys) + FEWEST_RANKED_ROWS:
        return True
    x = np.array([[r.values[k] for k in keys] for r in rows])
    plane = np.column_stack(
        [np.ones(len(rows)), x / np.maximum(np.ptp(x, axis=0), SMALLEST_NUMBER)]
    )

    def slope(values: list[float]) -> float:
        """Standard deviations of a figure per width of the span, outward."""
        y = np.array(values)
        fitted = np.linalg.lstsq(plane, y, rcond=None)[0]
        return outward * float(fitted[1 + keys.index(key)]) / max(float(y.std()), SMALLEST_NUMBER)

    gains = [
        slope([r.outcome.figures[k] for r in rows]) * (1 if goal == "maximize" else -1)
        for k, goal in file.objective.items()
    ]
    best = result.pareto[0].outcome.figures
    eases = [
        -slope([limit.excess(r.outcome.figures[k]) for r in rows])
        for k, limit in file.constraint.items()
        if _holds(limit, best[k])
    ]
    return any(s > WORTH_DEVIATIONS for s in (*gains, *eases))


def _holds(limit: Limit, value: float) -> bool:
    """Whether a constraint holds a design with this figure back."""
    return -limit.excess(value) <= AT_END * limit.size


def disagreement(check: Check) -> str:
    """Why the fast and the solid model may differ by more than they should."""
    if check.fast_bounds and check.solid_bounds:
        return (
            "they disagree beyond their bounds; the fast model knows the shaft's holes only as the nominal "
            "design's"
        )
    return (
        f"they differ by more than {100 * STRESS_SHARE:g} %; without bounds of either: the fast model's "
        "mesh is the finer one, holes near the peak are in the solid one alone"
    )


def unfollowed(study: Study) -> str:
    """Keys of the shaft's holes and keyway that the study changes; "" where there are none."""
    return ", ".join(unfollowed_keys(study.keys))


def incomplete(result: StudyResult) -> str:
    """How many designs lack a figure that neither objective nor constraint asks for."""
    count = len(result.incomplete)
    lack = "1 design lacks" if count == 1 else f"{count} designs lack"
    return f"{lack} a figure that the study does not ask for (column reason)"


def _is_its_own(x: np.ndarray, y: np.ndarray, others: list[np.ndarray]) -> bool:
    """Whether x moves y beside the others: by the partial rank correlation, beyond what chance gives."""
    from scipy.stats import rankdata, t

    free = len(x) - len(others) - 2
    if free < 1:
        return False
    beside = np.column_stack([np.ones(len(x)), *map(rankdata, others)])
    ranks = np.column_stack([rankdata(x), rankdata(y)])
    own = ranks - beside @ np.linalg.lstsq(beside, ranks, rcond=None)[0]
    size = np.linalg.norm(own, axis=0)
    if not (size > SAME * np.linalg.norm(ranks, axis=0)).all():  # the others stand for one of them
        return True
    rho = float(own[:, 0] @ own[:, 1] / size.prod())
    chance = t.isf(BY_CHANCE / 2, free)
    return abs(rho) > chance / np.sqrt(free + chance**2)


def _spearman(x: np.ndarray, y: np.ndarray) -> float:
    from scipy.stats import spearmanr

    return float(spearmanr(x, y).statistic)
