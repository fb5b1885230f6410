"""Influences on the figures of a study's designs, and the limits that stop its best design."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from flexspline.geometry.ranges import SMALLEST_NUMBER
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.result import StudyResult

BY_CHANCE = 0.01
"""Of dimensions that move nothing, the share that a report may say something of."""
RANK_ROUNDING = 1e-9
"""Of ranks that others make up to rounding."""
END_SHARE = 0.02
"""Of a span: a best design so near its end would go on if it could."""
FEWEST_RANKED_ROWS = 8
"""Rows from which a rank correlation says something, and beyond the dimensions a plane."""
WORTH_DEVIATIONS = 0.1
"""Standard deviations of a figure across a whole span: less is no influence that is worth a word."""


@dataclass(frozen=True)
class Influence:
    """A varied key that moves a figure by itself, and Spearman's rank correlation of both."""

    key: str
    correlation: float


@dataclass(frozen=True)
class OpenEnd:
    """The end of a varied key's span, beyond which a better design may lie."""

    key: str
    value: float
    end: Literal["lower", "upper"]


def own_influences(result: StudyResult) -> dict[str, tuple[Influence, ...]]:
    """Return the keys that move each figure, over all designs built, the strongest first.

    Nothing of a tolerance study, whose indices say it, and of few designs. An optimiser's designs move
    several dimensions together, and few designs agree by chance: what is no influence of the dimension itself
    is left out.
    """
    rows = result.built
    if len(rows) < FEWEST_RANKED_ROWS or result.about_scatter:
        return {}
    values = {key: np.array([r.values[key] for r in rows]) for key in result.study.file.vary}
    moved = {key: x for key, x in values.items() if np.ptp(x) > 0}
    influences = {}
    for figure in result.shown:
        y = np.array([r.outcome.figures[figure] for r in rows])
        of_figure = [
            Influence(key, _spearman(x, y))
            for key, x in moved.items()
            if np.ptp(y) > 0
            and _is_its_own(x, y, [moved[other] for other in moved if other != key])
        ]
        influences[figure] = tuple(sorted(of_figure, key=lambda i: -abs(i.correlation)))
    return influences


def open_ends(result: StudyResult, best: Row) -> tuple[OpenEnd, ...]:
    """Return the ends of spans at which the best design lies, though it would gain beyond them.

    A key of one value has no span, and one that only one built design has tells nothing.
    """
    open_at: list[OpenEnd] = []
    for key, (low, high) in _spans(result).items():
        ends = (OpenEnd(key, low, "lower"), OpenEnd(key, high, "upper"))
        near = (e for e in ends if abs(best.values[key] - e.value) <= END_SHARE * (high - low))
        open_at += [e for e in near if _may_help(result, best, key, 1 if e.value == high else -1)]
    return tuple(open_at)


def binding(result: StudyResult, best: Row) -> tuple[str, ...]:
    """Figures whose constraints hold the best design back: it is near the limit, beyond which a better
    design was built."""
    better = [r for r in result.built if result.is_better(r, best)]
    return tuple(
        key for key, limit in result.study.file.constraint.items()
        if -limit.excess(best.outcome.figures[key]) <= END_SHARE * limit.size
        and any(limit.excess(r.outcome.figures[key]) > 0 for r in better)
    )  # fmt: skip


def unbuilt_neighbours(result: StudyResult, best: Row) -> tuple[tuple[str, float], ...]:
    """Return keys and values next to the best design's in a grid that gave no design, all else alike.

    Without those towards which the objective is seen to get worse.
    """
    if result.study.file.run.method != "grid":
        return ()
    neighbours: list[tuple[str, float]] = []
    for key in _spans(result):
        for outward in (-1, 1):
            near, opposite = (_next(result.rows, best, key, way) for way in (outward, -outward))
            if near is None or near in result.built:
                continue
            if opposite not in result.built or not result.is_better(opposite, best):
                neighbours.append((key, near.values[key]))
    return tuple(neighbours)


def _spans(result: StudyResult) -> dict[str, tuple[float, float]]:
    """Both ends of each varied key that has more than one value."""
    ends = {key: span.ends for key, span in result.study.file.vary.items()}
    return {key: (low, high) for key, (low, high) in ends.items() if low < high}


def _next(rows: Iterable[Row], best: Row, key: str, outward: int) -> Row | None:
    """The row that differs from the best design in that key alone and is next to it on that side."""

    def step(row: Row) -> float:
        return outward * (row.values[key] - best.values[key])

    line = (r for r in rows if step(r) > 0 and r.values == {**best.values, key: r.values[key]})
    return min(line, key=step, default=None)


def _may_help(result: StudyResult, best: Row, key: str, outward: int) -> bool:
    """Whether an objective is seen to gain that way.

    Against the next design inward that differs in that key alone; without one by the slopes of a plane
    through all designs built, every dimension in its span's width. Gains count in a figure's scatter per
    width of the span. Designs too few for a plane show nothing.
    """
    rows, spans = result.built, _spans(result)
    inward = _next(rows, best, key, -outward)
    keys = [k for k in spans if len({r.values[k] for r in rows}) > 1]
    if inward is None and (key not in keys or len(rows) < len(keys) + FEWEST_RANKED_ROWS):
        return False
    low, high = spans[key]
    x = np.array([[r.values[k] for k in keys] for r in rows])
    x = (x - x.min(axis=0)) / np.ptp(x, axis=0)
    plane = np.column_stack([np.ones(len(rows)), x])

    def gain(figure: str) -> float:
        y = np.array([r.outcome.figures[figure] for r in rows])
        if inward is not None:
            gained = best.outcome.figures[figure] - inward.outcome.figures[figure]
            slope = gained * (high - low) / abs(best.values[key] - inward.values[key])
        else:
            slope = outward * float(np.linalg.lstsq(plane, y, rcond=None)[0][1 + keys.index(key)])
        return slope / max(float(y.std()), SMALLEST_NUMBER)

    return any(
        (1 if goal == "maximize" else -1) * gain(figure) > WORTH_DEVIATIONS
        for figure, goal in result.study.file.objective.items()
    )


def _is_its_own(x: np.ndarray, y: np.ndarray, others: list[np.ndarray]) -> bool:
    """Whether x moves y beside the others: by the partial rank correlation, beyond what chance gives."""
    from scipy.stats import rankdata, t

    free = len(x) - len(others) - 2
    if free < 1:
        return False
    beside = np.column_stack([np.ones(len(x)), *map(rankdata, others)])
    ranks = np.column_stack([rankdata(x), rankdata(y)])
    residuals = ranks - beside @ np.linalg.lstsq(beside, ranks, rcond=None)[0]
    size = np.linalg.norm(residuals, axis=0)
    # else the others stand for one of them
    if not (size > RANK_ROUNDING * np.linalg.norm(ranks, axis=0)).all():
        return True
    rho = float(residuals[:, 0] @ residuals[:, 1] / size.prod())
    chance = t.isf(BY_CHANCE / 2, free)
    return abs(rho) > chance / np.sqrt(free + chance**2)


def _spearman(x: np.ndarray, y: np.ndarray) -> float:
    from scipy.stats import spearmanr

    return float(spearmanr(x, y).statistic)
