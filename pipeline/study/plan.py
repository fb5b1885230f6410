"""Which designs a study evaluates: known beforehand for a grid or sobol, one by one for optimize."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from flexspline.geometry.errors import plain_number
from flexspline.pipeline.study.study import Study
from flexspline.pipeline.study.trial_tables import Values

ROOT_ROUNDING = 1e-9
"""Steps of an axis: 125 ** (1 / 3) is 4.999…, short by 1e-15, and no other root is as near."""


class StudyPlan(Protocol):
    """A plan gives values of design `index`, the same whoever asks and whenever."""

    @property
    def size(self) -> int:
        """Number of designs."""

    def point(self, index: int) -> Values:
        """Return the values by varied key."""


@dataclass(frozen=True)
class Listed:
    """A plan held as an array (n, k) of values for k keys."""

    keys: tuple[str, ...]
    points: np.ndarray

    @property
    def size(self) -> int:
        return len(self.points)

    def point(self, index: int) -> Values:
        return dict(zip(self.keys, (float(v) for v in self.points[index]), strict=True))


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


@dataclass(frozen=True)
class Sobol:
    """Owen-scrambled Sobol points; a longer study begins with the same designs."""

    study: Study

    @property
    def size(self) -> int:
        return self.study.file.run.evaluations

    @cached_property
    def _unit(self) -> np.ndarray:
        """Points (n, k) in [0, 1), n the power of two that holds all: what scipy draws in one piece."""
        from scipy.stats import qmc

        engine = qmc.Sobol(len(self.study.file.vary), scramble=True, seed=self.study.file.run.seed)
        return engine.random_base2((self.size - 1).bit_length())

    def point(self, index: int) -> Values:
        return {
            key: from_unit(self.study, key, float(u))
            for key, u in zip(self.study.file.vary, self._unit[index], strict=True)
        }


def from_unit(study: Study, key: str, u: float) -> float:
    """Spread a number in [0, 1) over a key's span."""
    span = study.file.vary[key]
    if span.values is not None:
        return span.values[min(int(u * len(span.values)), len(span.values) - 1)]
    low, high = span.ends
    if key in study.whole:
        count = int(high) - int(low) + 1
        return float(int(low) + min(int(u * count), count - 1))
    return low + u * (high - low)


def linked(study: Study, values: Values) -> dict[str, float]:
    """Add the keys of [link] that follow the varied ones."""
    follow = {k: link.times * values[link.of] + link.plus for k, link in study.file.link.items()}
    return {**values, **follow}
