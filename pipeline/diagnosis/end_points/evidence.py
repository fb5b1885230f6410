"""Units under one prior: how much of a deviation is common, how much is one unit's own.

Totals of all rows, d = total − 2T·compliance − gap, are jointly normal. Young's modulus is common.
The gap's stated variance is split between a part common to all units (share ρ) and each unit's own;
ρ and the reading's standard deviation σ are not known and are integrated over grids. The covariance
is block diagonal by unit but for few common columns, so a likelihood costs O(rows).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log, pi

import numpy as np
from scipy.special import log_ndtr, logsumexp

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.pipeline.diagnosis.end_points.regressors import EndPointRegressor

CORRELATIONS = (0.1, 0.5, 0.9)
"""ρ; even odds."""
READINGS = 5
"""Points of the grid of σ."""
LARGEST_READING = 0.05
"""σ goes from the file's resolution to this share of the median total, in even steps of log σ."""


@dataclass(frozen=True)
class UnitDeviations:
    """Deviations of all rows, and their prior.

    Attributes
    ----------
    deviation : (n,) measured − predicted total [arcsec]. mid : (n,) mid positions [arcsec].
    torque : (n,) [N·m]. unit : (n,) index of the unit.
    modulus_std : of 2T·compliance, per N·m [arcsec per N·m]; gap_std [arcsec].
    readings : σ of a total, the grid [arcsec].
    """

    deviation: np.ndarray
    mid: np.ndarray
    torque: np.ndarray
    unit: np.ndarray
    modulus_std: float
    gap_std: float
    readings: tuple[float, ...]

    @property
    def units(self) -> int:
        return int(self.unit.max()) + 1

    @property
    def unit_rows(self) -> list[np.ndarray]:
        """Row indices of each unit."""
        order = np.argsort(self.unit, kind="stable")
        return np.split(order, np.cumsum(np.bincount(self.unit))[:-1])


@dataclass(frozen=True)
class UnitEvidence:
    """A set of terms: log evidence, the largest log likelihood, amplitudes and their covariance.

    `common` is the posterior (mean, std) of the gap's common part, `own` (units,) that of each
    unit's own part, over ρ and σ; `share` is ρ's posterior mean.
    """

    terms: tuple[EndPointRegressor, ...]
    evidence: float
    likelihood: float
    mean: np.ndarray
    std: np.ndarray
    common: tuple[float, float]
    own: np.ndarray
    share: float
    reading: float


def readings(resolution_arcsec: float, total_arcsec: np.ndarray) -> tuple[float, ...]:
    """σ of a total; two angles rounded to a resolution q leave q/√6."""
    low = max(resolution_arcsec / 6**0.5, 1e-3)
    high = max(LARGEST_READING * float(np.median(np.abs(total_arcsec))), 2 * low)
    return tuple(float(s) for s in np.geomspace(low, high, READINGS))


def unit_evidence(deviations: UnitDeviations, terms: Sequence[EndPointRegressor]) -> UnitEvidence:
    """Evidence of a set of terms, over the grids of ρ and σ."""
    cells = [
        _cell(deviations, terms, rho, sigma) for rho in CORRELATIONS for sigma in deviations.readings
    ]  # fmt: skip
    logs = np.array([c[0] for c in cells])
    weight = np.exp(logs - logsumexp(logs))
    k = len(terms)
    means = np.array([c[2] for c in cells])
    variances = np.array([c[3] for c in cells])
    mean = weight @ means
    std = np.sqrt(weight @ (variances + (means - mean) ** 2))
    grid = [(rho, sigma) for rho in CORRELATIONS for sigma in deviations.readings]
    own = weight @ np.array([c[4] for c in cells])
    return UnitEvidence(
        tuple(terms),
        float(logsumexp(logs) - log(len(logs))),
        max(c[1] for c in cells),
        mean[:k], std[:k],
        (float(mean[k + 1]), float(std[k + 1])),
        own,
        float(weight @ np.array([g[0] for g in grid])),
        float(np.exp(weight @ np.log([g[1] for g in grid]))),
    )  # fmt: skip


def _cell(
    deviations: UnitDeviations, terms: Sequence[EndPointRegressor], rho: float, sigma: float
) -> tuple[float, float, np.ndarray, np.ndarray, np.ndarray]:
    """Log evidence, log likelihood at the mean, posterior means and variances, own parts.

    Parameters are the terms' amplitudes, Young's modulus, the gap's common part, and, for the mid
    positions, each unit's free zero.
    """
    n = len(deviations.deviation)
    total = [t for t in terms if t.channel == "total"]
    columns = [*(t.column for t in total), 2 * deviations.torque, np.ones(n)]
    prior = [*(t.spread for t in total), deviations.modulus_std, deviations.gap_std * rho**0.5]
    own_variance = deviations.gap_std**2 * (1 - rho)
    ev, like, mean, cov, left = _linear(
        deviations.deviation,
        np.column_stack(columns),
        np.array(prior),
        deviations,
        own_variance,
        sigma,
    )
    middle = [t for t in terms if t.channel == "mid"]
    # a unit's zero may be anything: its prior is as wide as the mid positions are far
    anything = (10 * (np.abs(deviations.mid).max() + sigma)) ** 2
    ev_mid, like_mid, mean_mid, cov_mid, _ = _linear(
        deviations.mid, np.array([t.column for t in middle]).T.reshape(n, len(middle)),
        np.array([t.spread for t in middle]), deviations, anything, sigma / 2,
    )  # fmt: skip
    means, variances = np.zeros(len(terms) + 2), np.zeros(len(terms) + 2)
    it, im = 0, 0
    sign = 0.0
    for i, t in enumerate(terms):
        if t.channel == "total":
            means[i], variances[i] = mean[it], cov[it, it]
            it += 1
        else:
            means[i], variances[i] = mean_mid[im], cov_mid[im, im]
            im += 1
        if t.positive:  # half a normal prior: what of the posterior lies there, twice
            sign += log(2) + float(log_ndtr(means[i] / max(variances[i], ABOVE_ZERO) ** 0.5))
    means[-2:], variances[-2:] = mean[it:], np.diag(cov)[it:]
    count = np.bincount(deviations.unit, minlength=deviations.units)
    shrink = own_variance / (sigma**2 + own_variance * count)
    own = shrink * np.bincount(deviations.unit, left, minlength=deviations.units)
    return ev + ev_mid + sign, like + like_mid, means, variances, own


def _linear(
    y: np.ndarray,
    columns: np.ndarray,
    prior: np.ndarray,
    deviations: UnitDeviations,
    own: float,
    sigma: float,
) -> tuple[float, float, np.ndarray, np.ndarray, np.ndarray]:
    """Normal linear model with unit blocks σ²I + own·11ᵀ: evidence, likelihood, mean, cov, residual."""
    count = np.bincount(deviations.unit, minlength=deviations.units)
    pull = own / (sigma**2 + own * count)

    def weighted(v: np.ndarray) -> np.ndarray:
        sums = np.column_stack(
            [
                np.bincount(deviations.unit, v[:, j], minlength=deviations.units)
                for j in range(v.shape[1])
            ]
        )
        return (v - (pull[:, None] * sums)[deviations.unit]) / sigma**2

    logdet = float(np.sum((count - 1) * 2 * log(sigma) + np.log(sigma**2 + own * count)))
    scaled = columns * prior
    w = weighted(np.column_stack([y, scaled]))
    quadratic = float(y @ w[:, 0])
    inner = scaled.T @ w[:, 1:] + np.eye(len(prior))
    right = scaled.T @ w[:, 0]
    solved = np.linalg.solve(inner, right) if len(prior) else right
    mean = prior * solved
    cov = np.linalg.inv(inner) * np.outer(prior, prior) if len(prior) else np.zeros((0, 0))
    constant = len(y) * log(2 * pi) + logdet
    evidence = -(quadratic - float(right @ solved) + np.linalg.slogdet(inner)[1] + constant) / 2
    left = y - columns @ mean
    likelihood = (
        -(float(left @ weighted(left[:, None])[:, 0]) + constant + float(solved @ solved)) / 2
    )
    return float(evidence), likelihood, mean, cov, left
