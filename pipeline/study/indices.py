"""Sobol indices with intervals, and the conditions under which a sample gives them.

First order S_i: the share of the variance that input i explains alone; total T_i: with all it acts together
with (Saltelli et al., Comput. Phys. Commun. 181, 2010, 259-270).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import e

import numpy as np

CONFIDENCE = 0.95
"""Usual in statistics; the intervals are told with it."""
MOST_GROUPS = 64
"""Of sample blocks, left out in turn: a standard deviation from so many is known to 9 %."""
HALF_DIGIT = 0.005
"""Half the last digit shown: no interval is narrower."""
WIDEST_INTERVAL = 0.15
"""± of an index beyond which it says too little to be shown."""
NET = e**0.5
"""A scrambled net's standard deviation is at most so many times that of independent points (Owen, Ann.
Statist. 25, 1997, 1541-1562); 512 blocks of the Ishigami function need 1.25 of it."""


@dataclass(frozen=True)
class Indices:
    """Sobol indices of each input (k,), and the ends of their CONFIDENCE intervals (k, 2)."""

    first: np.ndarray
    first_ends: np.ndarray
    total: np.ndarray
    total_ends: np.ndarray

    @property
    def widest(self) -> float:
        """Half the widest interval."""
        return float(
            max(np.ptp(ends, axis=1).max() for ends in (self.first_ends, self.total_ends)) / 2
        )

    @property
    def is_known(self) -> bool:
        """Whether every index is known well enough to be shown."""
        return self.widest <= WIDEST_INTERVAL


def groups_of(blocks: int) -> list[slice]:
    """Return consecutive sample blocks in at most MOST_GROUPS groups."""
    ends = np.linspace(0, blocks, min(blocks, MOST_GROUPS) + 1).astype(int)
    return [slice(int(a), int(b)) for a, b in pairwise(ends)]


def reach(left_out: np.ndarray) -> np.ndarray:
    """Return half the CONFIDENCE interval of a figure from its values with one group of G left out, (G, …).

    The jackknife's standard deviation (Efron and Stein, Ann. Statist. 9, 1981, 586-596: on average too
    large, never too small) times Student's factor for G − 1.
    """
    count = len(left_out)
    spread = np.sqrt((count - 1) * np.var(left_out, axis=0))
    return np.asarray(students_factor(count - 1) * spread)


def students_factor(freedom: int) -> float:
    """Return how many standard deviations hold CONFIDENCE."""
    from scipy.stats import t

    return float(t.ppf((1 + CONFIDENCE) / 2, freedom))


def within(low: np.ndarray, value: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return interval ends (k, 2) about values, at least HALF_DIGIT to either side, none beyond [0, 1]."""
    ends = np.column_stack(
        [np.minimum(low, value - HALF_DIGIT), np.maximum(high, value + HALF_DIGIT)]
    )
    return np.clip(ends, 0, 1)


def sampled_indices(blocks: np.ndarray) -> tuple[Indices, float]:
    """Return indices from values (N, k + 2) at Saltelli's points, and the largest ± before the ends 0 and 1.

    First order by Saltelli's estimator b(ab_i − a), total by Jansen's (a − ab_i)²/2, both about the mean.
    """
    k = blocks.shape[1] - 2
    y = blocks - blocks[:, [0, -1]].mean()
    a, ab, b = y[:, :1], y[:, 1:-1], y[:, -1:]
    terms = np.hstack([(a**2 + b**2) / 2, (a + b) / 2, b * (ab - a), (a - ab) ** 2 / 2])

    def shares(mean: np.ndarray) -> np.ndarray:
        variance = mean[..., :1] - mean[..., 1:2] ** 2
        return np.asarray(mean[..., 2:] / variance)

    left_out = (terms.sum(axis=0) - terms) / (len(terms) - 1)
    value, half = shares(terms.mean(axis=0)), NET * reach(shares(left_out))
    ends, shown = within(value - half, value, value + half), np.clip(value, 0, 1)
    return Indices(shown[:k], ends[:k], shown[k:], ends[k:]), float(half.max())
