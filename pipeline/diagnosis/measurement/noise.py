"""The coloured noise of a record: its estimate, and rows whitened by it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.fft import next_fast_len
from scipy.optimize import nnls

from flexspline.pipeline.diagnosis.measurement.floors import ROUNDING_OF_SUMS
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.recursion import first_order

LONGEST_OF_CYCLE = 0.1
"""Longest correlation time of the noise over a cycle. A longer one would absorb drift and wear."""
FINEST_ARCSEC = 0.005
"""Least standard deviation of a reading: no instrument repeats better, and without any noise every equation
would be singular."""
LAGS = 24
"""Lags up to which the residual's autocovariances are matched one by one; larger lags are matched in groups.
Judgement."""
LAGS_PER_MEMORY = 3.0
"""Largest lag over the longest correlation time allowed. An exponential has fallen to 5 % there."""
GROUPS_PER_LOG = 5.0
"""Groups of lags for each factor e: within one of them an exponential of its length falls by a fifth."""
LAG_0_WEIGHT = 3.0
"""Weight of the variance against the autocovariances in the matching: it has the largest value and the
smallest error. Judgement."""
LEAST_LAG_1 = 1e-12
"""Share of the moving average's variance: a smaller covariance of neighbours is rounding."""
MEMORIES = 16
"""Correlation times tried, in even steps of their log: up to 50 rows they are 36 % apart."""


@dataclass(frozen=True)
class Noise:
    """White noise plus a first-order autoregression along the rows of each stretch.

    Attributes
    ----------
    white, coloured : variances [arcsec²]. memory : correlation of the coloured part between rows.
    """

    white: float
    coloured: float
    memory: float

    @property
    def std_arcsec(self) -> float:
        """Of one row."""
        return float(np.sqrt(self.variance))

    @property
    def variance(self) -> float:
        """Of one row [arcsec²]."""
        return self.white + self.coloured

    @property
    def slow_power(self) -> float:
        """Variance [arcsec²] of a mean over many rows times their number: Σ of all autocovariances."""
        return self.white + self.coloured * (1 + self.memory) / (1 - self.memory)

    def whitened(self, values: np.ndarray, stretches: list[slice]) -> np.ndarray:
        """(n, …) values that would be independent with variance 1 were they this noise."""
        return self.whitener(stretches)(values)

    def whitener(self, stretches: list[slice]) -> Whitener:
        """What whitens columns of those stretches, each of which starts from rest.

        The sum of the two parts is an ARMA(1,1) process: its innovations, with the memory ρ and a
        moving-average root θ, are e_t = x_t − ρ x_{t−1} + θ e_{t−1}.
        """
        rho, total = self.memory, self.variance
        n = stretches[-1].stop if stretches else 0
        if self.coloured <= ROUNDING_OF_SUMS * total:
            return Whitener(None, None, np.full(n, np.sqrt(total)))
        # (1 + θ²)s² and −θs² are the moving average's covariances at lags 0 and 1
        zero = total * (1 + rho**2) - 2 * rho * rho * self.coloured
        one = rho * (self.coloured - total)  # = −ρ·white
        ratio = -zero / (2 * one) if one < -LEAST_LAG_1 * zero else np.inf
        theta = ratio - np.sqrt(ratio**2 - 1) if np.isfinite(ratio) else 0.0
        s2 = -one / theta if theta > 0 else zero
        starts = np.array([s.start for s in stretches])
        since = np.arange(n) - np.repeat(starts, [_length(s) for s in stretches])
        goes_on = (since[1:] > 0).astype(float)
        # a start from rest: the first innovations have a larger variance, which decays as θ^2k
        extra = (total - s2) * np.float64(theta**2) ** since
        return Whitener(rho * goes_on, theta * goes_on, np.sqrt(s2 + extra))


@dataclass(frozen=True)
class Whitener:
    """Innovations e_t = x_t − `before`·x_{t−1} + `again`·e_{t−1} over their deviation `std` (n,).

    `before` and `again` (n − 1,) : None where rows are independent.
    """

    before: np.ndarray | None
    again: np.ndarray | None
    std: np.ndarray

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """(n, …) whitened."""
        shape = (-1,) + (1,) * (values.ndim - 1)
        if self.before is None or self.again is None:
            return values / self.std.reshape(shape)
        changed = values.astype(float, order="F")
        changed[1:] -= self.before.reshape(shape) * values[:-1]
        return first_order(self.again, changed) / self.std.reshape(shape)


def stretches_of(history: History, kept: np.ndarray) -> list[slice]:
    """Slices of the kept rows within which neighbours were neighbours in the record.

    Single dropped rows do not cut a stretch; two or more, or another unit, do.
    """
    rows = np.flatnonzero(kept)
    if len(rows) == 0:
        return []
    cut = (np.diff(rows) > 2) | (np.diff(history.unit[rows]) != 0)
    edges = np.concatenate([[0], np.flatnonzero(cut) + 1, [len(rows)]])
    return [slice(a, b) for a, b in pairwise(edges)]


def estimated(
    residual: np.ndarray, stretches: list[slice], rows_per_cycle: float, used: int
) -> Noise:
    """Noise that has the residual's autocovariances; `used` parameters were fitted.

    They are matched by a non-negative white part and a non-negative coloured one, over a grid of memories up
    to the longest allowed, over lags of several times that: a slow noise is seen over no shorter ones.
    """
    n = len(residual)
    longest = max(1.0, LONGEST_OF_CYCLE * rows_per_cycle)
    shortest = min(LAGS, max(1, n // 8))
    farthest = max(shortest, min(int(LAGS_PER_MEMORY * longest), n // 8))
    products, pairs = _autocovariance(residual, stretches, farthest)
    grow = n / max(n - used, n // 3, 1)
    groups = _lag_groups(shortest, farthest)
    counts = np.maximum(np.add.reduceat(pairs, groups), 1.0)
    cov = grow * np.add.reduceat(products, groups) / counts
    weight = np.minimum(np.sqrt(counts / n), 1.0)
    weight[1 : shortest + 1] = 1.0
    weight[0] = LAG_0_WEIGHT
    best: tuple[float, Noise] | None = None
    for time in np.geomspace(0.5, longest, MEMORIES) if longest > 0.5 else [0.5]:
        rho = float(np.exp(-1 / time))
        fall = np.add.reduceat(pairs * rho ** np.arange(farthest + 1), groups) / counts
        basis = np.column_stack([np.eye(len(groups))[0], fall])
        amount, misfit = nnls(basis * weight[:, None], cov * weight)
        if best is None or misfit < best[0]:
            best = misfit, Noise(float(amount[0]), float(amount[1]), rho)
    assert best is not None
    noise = best[1]
    # a millionth of the variance keeps the equations of purely coloured noise regular
    floor = max(1e-6 * float(np.var(residual)), FINEST_ARCSEC**2)
    return Noise(noise.white + floor, noise.coloured, noise.memory)


def _autocovariance(
    residual: np.ndarray, stretches: list[slice], farthest: int
) -> tuple[np.ndarray, np.ndarray]:
    """(farthest + 1,) sums of products of rows 0, 1, … apart in one stretch, and how many there are."""
    products, pairs = np.zeros(farthest + 1), np.zeros(farthest + 1)
    for s in stretches:
        count = _length(s)
        reach = min(count, farthest + 1)
        power = np.abs(np.fft.rfft(residual[s], next_fast_len(count + reach))) ** 2
        products[:reach] += np.fft.irfft(power, next_fast_len(count + reach))[:reach]
        pairs[:reach] += count - np.arange(reach)
    return products, pairs


def _lag_groups(shortest: int, farthest: int) -> np.ndarray:
    """First lag of each group: one by one up to `shortest`, then ever longer ones up to `farthest`."""
    if farthest <= shortest:
        return np.arange(shortest + 1)
    count = int(np.ceil(GROUPS_PER_LOG * np.log((farthest + 1) / (shortest + 1))))
    edges = np.geomspace(shortest + 1, farthest + 1, count + 1)[:-1].round().astype(int)
    return np.unique(np.r_[np.arange(shortest + 1), edges])


def _length(s: slice) -> int:
    return int(s.stop - s.start)
