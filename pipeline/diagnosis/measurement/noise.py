"""The noise of a record: coloured, with outliers, and in the torque too."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg.lapack import dtbtrs
from scipy.optimize import nnls

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_program import torque_noise_Nm
from flexspline.pipeline.diagnosis.robust import SIGMA_PER_MAD

LONGEST_OF_CYCLE = 0.1
"""The noise's correlation time is kept below this share of a cycle: longer, and it eats drift and wear."""
FINEST_ARCSEC = 0.005
"""No instrument reads finer; a record without any noise would make every equation singular."""
LAGS = 24
"""Rows over which the residual's autocovariance is matched."""
LAG_0_WEIGHT = 3.0
"""Of the variance against the autocovariances, in matching: it has the largest value and the least error."""
MEMORIES = 16
"""Correlation times tried, in even steps of their log: up to 50 rows they are 36 % apart."""
OUTLIER_SIGMAS = 5.0
"""One row of normal noise in 1.7 million lies further off."""
SAME_PLACE = 0.01
"""Of the largest torque: outliers so near to each other, in other cycles, are at one place."""
LONGEST_OUTLIER = 2
"""Rows: three in a row are a finding."""
BAND_SIGMAS, BAND_SHARE = 4.0, 0.035
"""Half width of the crossing: standard deviations of the torque noise (one row in 16 000 lies further
off), and at least this share of the largest torque; docs/diagnosis.md, "Which rows"."""


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
        return float(np.sqrt(self.white + self.coloured))

    def whitened(self, values: np.ndarray, stretches: list[slice]) -> np.ndarray:
        """(n, …) values that would be independent with variance 1 were they this noise.

        The sum of the two parts is an ARMA(1,1) process: its innovations, with the memory ρ and a
        moving-average root θ, are e_t = x_t − ρ x_{t−1} + θ e_{t−1}. Each stretch starts anew.
        """
        rho, total = self.memory, self.white + self.coloured
        out = np.empty_like(values)
        if self.coloured <= 1e-9 * total:
            return values / np.sqrt(total)
        # (1 + θ²)s² and −θs² are the moving average's covariances at lags 0 and 1
        zero = total * (1 + rho**2) - 2 * rho * rho * self.coloured
        one = rho * (self.coloured - total)  # = −ρ·white
        ratio = -zero / (2 * one) if one < -1e-12 * zero else np.inf
        theta = ratio - np.sqrt(ratio**2 - 1) if np.isfinite(ratio) else 0.0
        s2 = -one / theta if theta > 0 else zero
        shape = (-1,) + (1,) * (values.ndim - 1)
        for s in stretches:
            e = _innovations(values[s], rho, theta)
            # a start from rest: the first innovations have a larger variance, which decays as θ^2k
            extra = (total - s2) * np.float64(theta**2) ** np.arange(len(e))
            out[s] = e / np.sqrt(s2 + extra).reshape(shape)
        return out


def _innovations(values: np.ndarray, rho: float, theta: float) -> np.ndarray:
    """e_t = x_t − ρ x_{t−1} + θ e_{t−1} from rest: a lower bidiagonal system of equations."""
    right = np.array(values, dtype=float, order="F")
    right[1:] -= rho * values[:-1]
    band = np.ones((2, len(right)), order="F")
    band[1] = -theta
    return np.asarray(dtbtrs(band, right, uplo="L", diag="U", overwrite_b=1)[0]).reshape(
        values.shape
    )


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

    Lags 0 to 24 are matched by a non-negative white part and a non-negative coloured one, over a grid
    of memories up to the longest allowed.
    """
    n = len(residual)
    lags = int(min(LAGS, max(1, n // 8)))
    grow = n / max(n - used, n // 3, 1)
    cov = np.empty(lags + 1)
    for k in range(lags + 1):
        pairs = [
            residual[s][k:] * residual[s][: len(residual[s]) - k]
            for s in stretches
            if _length(s) > k
        ]
        cov[k] = np.concatenate(pairs).mean() if pairs else 0.0
    cov *= grow
    longest = max(1.0, LONGEST_OF_CYCLE * rows_per_cycle)
    best: tuple[float, Noise] | None = None
    weight = np.r_[LAG_0_WEIGHT, np.ones(lags)]
    for time in np.geomspace(0.5, longest, MEMORIES) if longest > 0.5 else [0.5]:
        rho = float(np.exp(-1 / time))
        basis = np.column_stack([np.eye(lags + 1)[0], rho ** np.arange(lags + 1)])
        amount, misfit = nnls(basis * weight[:, None], cov * weight)
        if best is None or misfit < best[0]:
            best = misfit, Noise(float(amount[0]), float(amount[1]), rho)
    assert best is not None
    found = best[1]
    floor = max(1e-6 * float(np.var(residual)), FINEST_ARCSEC**2)
    return Noise(found.white + floor, found.coloured, found.memory)


def crossing_band_Nm(history: History) -> float:
    """|T| below which the side of the gap is not known."""
    largest = float(np.abs(history.torque_Nm).max())
    return max(BAND_SIGMAS * torque_noise_Nm(history), BAND_SHARE * largest)


def isolated_outliers(residual: np.ndarray, history: History, sigma: float) -> np.ndarray:
    """(n,) rows that stand alone beyond 5σ; three in a row, or one place in several passes, stay."""
    far = np.abs(residual) > OUTLIER_SIGMAS * sigma
    if not far.any():
        return far
    out = far.copy()
    edges = np.diff(np.r_[0, far.astype(int), 0])
    for a, b in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
        if b - a > LONGEST_OUTLIER:
            out[a:b] = False
    rows = np.flatnonzero(out)
    rising = np.gradient(history.torque_Nm) > 0
    near = SAME_PLACE * np.abs(history.torque_Nm).max()
    for i in rows:
        same = (
            (np.abs(history.torque_Nm[rows] - history.torque_Nm[i]) < near)
            & (rising[rows] == rising[i])
            & (history.cycle[rows] != history.cycle[i])
            & (np.sign(residual[rows]) == np.sign(residual[i]))
        )
        if same.sum() >= 2:
            out[i] = False
    return out


def rough_residual(
    angle: np.ndarray, history: History, kept: np.ndarray, rows_per_cycle: float
) -> np.ndarray:
    """(kept,) what a local parabola leaves over windows of a twelfth of a cycle: noise and little else."""
    out = np.empty(int(kept.sum()))
    width = int(np.clip(rows_per_cycle / 12, 7, 400))
    y = angle[kept]
    for s in stretches_of(history, kept):
        piece = y[s]
        for a in range(0, len(piece), width):
            b = min(len(piece), a + width)
            if b - a < 7 and b == len(piece) and a > 0:
                a = max(0, b - width)
            x = np.linspace(-1, 1, b - a)
            degree = min(2, max(0, b - a - 4))
            out[s.start + a : s.start + b] = piece[a:b] - _robust_polynomial(x, piece[a:b], degree)
    return out


def _robust_polynomial(x: np.ndarray, y: np.ndarray, degree: int) -> np.ndarray:
    weight = np.ones(len(x))
    basis = np.vander(x, degree + 1)
    fitted = y
    for _ in range(3):
        coefficients = np.linalg.lstsq(basis * weight[:, None], y * weight, rcond=None)[0]
        fitted = basis @ coefficients
        off = np.abs(y - fitted)
        scale = SIGMA_PER_MAD * np.median(off) + 1e-12
        weight = 1 / np.maximum(1, off / (3 * scale))
    return fitted


def _length(s: slice) -> int:
    return int(s.stop - s.start)
