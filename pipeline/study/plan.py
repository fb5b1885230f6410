"""Which designs a study evaluates: known beforehand for a grid or sobol, one by one for optimize."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from flexspline.geometry.errors import plain_number
from flexspline.pipeline.study.study import Study
from flexspline.pipeline.study.trial_tables import Values

ROOT_ROUNDING = 1e-9
"""Steps of an axis: 125 ** (1 / 3) is 4.999…, short by 1e-15, and no other root is as near."""


@dataclass(frozen=True)
class Listed:
    """A plan held as an array (n, k) of values for k keys."""

    keys: tuple[str, ...]
    points: np.ndarray

    @property
    def size(self) -> int:
        return len(self.points)

    def point(self, index: int) -> Values:
        return dict(zip(self.keys, self.points[index].tolist(), strict=True))


@dataclass(frozen=True)
class GridPlan:
    """Every combination; the last key changes fastest."""

    axes: Mapping[str, Sequence[float]]

    @property
    def size(self) -> int:
        return int(np.prod([len(a) for a in self.axes.values()]))

    def point(self, index: int) -> Values:
        shape = [len(a) for a in self.axes.values()]
        at = np.unravel_index(index, shape)
        return {
            key: float(axis[int(i)]) for (key, axis), i in zip(self.axes.items(), at, strict=True)
        }


StudyPlan = Listed | GridPlan
"""Values of each design, the same whoever asks and whenever."""


def grid(study: Study) -> GridPlan:
    """Return a grid of `values` and `steps` as given; other spans share `evaluations`, at least two each."""
    spans, budget = study.file.vary, study.file.run.evaluations
    fixed = {k: len(s.values) if s.values else s.steps for k, s in spans.items()}
    taken = int(np.prod([n for n in fixed.values() if n] or [1]))
    open_keys = [k for k, n in fixed.items() if not n]
    share = (budget / taken) ** (1 / len(open_keys)) if open_keys else 0.0
    steps = max(2, int(share + ROOT_ROUNDING))
    axes: dict[str, list[float]] = {}
    for key, span in spans.items():
        if span.values is not None:
            axes[key] = list(span.values)
            continue
        axis = np.linspace(*span.ends, span.steps or steps)
        if key in study.whole:
            axis = np.unique(np.round(axis))
        axes[key] = [float(plain_number(v)) for v in axis]
    return GridPlan(axes)


def sobol(study: Study) -> Listed:
    """Return Owen-scrambled Sobol points; a longer study begins with the same designs."""
    from scipy.stats import qmc

    run, keys = study.file.run, tuple(study.file.vary)
    engine = qmc.Sobol(len(keys), scramble=True, seed=run.seed)
    drawn = engine.random_base2((run.evaluations - 1).bit_length())  # what scipy draws in one piece
    return Listed(keys, spread(study, drawn[: run.evaluations]))


def spread(study: Study, unit: np.ndarray) -> np.ndarray:
    """Return values (n, k) of the varied keys: numbers in [0, 1), (n, k), spread over each key's span."""
    columns = []
    for (key, span), u in zip(study.file.vary.items(), unit.T, strict=True):
        low, high = span.ends
        if span.values is not None:
            columns.append(np.array(span.values)[(u * len(span.values)).astype(int)])
        elif key in study.whole:
            columns.append(low + np.floor(u * (high - low + 1)))
        else:
            columns.append(low + u * (high - low))
    return np.column_stack(columns)


def linked(study: Study, values: Values) -> dict[str, float]:
    """Add the keys of [link] that follow the varied ones."""
    follow = {k: link.times * values[link.of] + link.plus for k, link in study.file.link.items()}
    return {**values, **follow}
