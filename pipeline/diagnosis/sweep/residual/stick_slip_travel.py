"""Test for stick-slip by travel: the residual changes with the torque travelled, not with time."""

from __future__ import annotations

import numpy as np
from scipy.special import ndtr

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.pipeline.diagnosis.causes.operators import steadied
from flexspline.pipeline.diagnosis.measurement.encoder_step import ROUNDING_RATIO
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.known_ways import still
from flexspline.pipeline.diagnosis.measurement.noise import Noise, stretches_of
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.residual.multiple_tests import p_value_of_best
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import STRUCTURE_P_VALUE
from flexspline.pipeline.diagnosis.sweep.residual.rounding import rounding_of_angle
from flexspline.pipeline.diagnosis.sweep.residual.stick_slip_skewness import Jumps

REACHES = (0.015, 0.04, 0.1)
"""Shares of the largest torque within which what sticks is forgotten: a factor of 2.6 apart, within which
exp(−s) and exp(−2.6 s) still have 92 % in common. A misfit of a smooth law is longer."""
FARTHEST = 16
"""Most rows between the two of a pair. Farther pairs of a hold add no information."""
TIME_DEGREE = 3
"""Degree of the polynomial in the time between two rows that represents noise of any colour. Judgement."""
SINGULAR_RATIO = 1e-9
"""Of the largest singular value: rows evenly in time have one time between them."""
MOST_OF_RESIDUAL = 2.0
"""Times the variance of what is left: what sticks is a part of it, and known to better than that."""
FEWEST_PAIRS = 8
"""Pairs so many rows apart: twice the polynomial's coefficients."""


def scatter_along_travel(prepared: PreparedSweep, fit: SweepFit) -> Jumps | None:
    """What sticks and breaks away at random, seen by pairs of rows; None where pairs say nothing of it.

    Where the output sticks, the residual stays what it is while torque moves little, as near a turn, and is
    another after a way longer than its teeth; of holds `stick_slip_rests.py` asks the same. Noise of the
    reading knows the time between two rows, not the way, and vibration of a drive that moves, however strong,
    is another in each row. So the products r_i·r_j of rows as many rows and as much time apart have one mean,
    whatever the way s_ij between them, but for what sticks: σ²·exp(−s_ij/ℓ). σ² is their slope over
    exp(−s_ij/ℓ), less what a polynomial in time can be of it. What sticks passes for noise, so the slope's
    deviation by the noise estimated is no less than by the gear's own. The rms is the σ of the ℓ that shows
    it best.
    """
    history, kept = prepared.rig.history, prepared.kept
    left = fit.residual()[kept]
    moved = steadied(history, deadband_Nm(history))
    way = np.cumsum(np.abs(np.diff(moved, prepend=moved[0])))[kept]
    time = history.time_or_rows(np.arange(len(kept)))
    pairs = _pairs(stretches_of(history, kept), _resting(history)[kept])
    largest = prepared.rig.largest_Nm
    scatters = [
        _slope(left, way / (share * largest), time[kept], pairs, prepared.noise)
        for share in REACHES
    ]
    deviations, variance = max(scatters)
    p_value = p_value_of_best(float(ndtr(-deviations)), len(scatters))
    if variance > MOST_OF_RESIDUAL * float(np.var(left)):  # rounding in step with the programme
        return None
    rounding = rounding_of_angle(prepared, fit).left_arcsec ** 2
    if p_value > STRUCTURE_P_VALUE or variance < ROUNDING_RATIO * rounding:
        return None
    return Jumps(p_value, float(np.sqrt(variance)))


def _resting(history: History) -> np.ndarray:
    """(n,) rows of holds."""
    out = np.zeros(len(history), bool)
    for hold in still(history):
        out[hold] = True
    return out


def _pairs(pieces: list[slice], resting: np.ndarray) -> list[np.ndarray]:
    """First rows (p,) of the pairs 1, 2, … `FARTHEST` rows apart, both in one stretch, neither in a hold."""
    pairs = []
    for k in range(1, FARTHEST + 1):
        first = np.concatenate([np.arange(s.start, max(s.start, s.stop - k)) for s in pieces])
        pairs.append(first[~resting[first] & ~resting[first + k]])
    return pairs


def _slope(
    left: np.ndarray, way: np.ndarray, time: np.ndarray, pairs: list[np.ndarray], noise: Noise
) -> tuple[float, float]:
    """σ² [arcsec²] in its standard deviations, and by itself; the way in reaches ℓ."""
    weights, total = np.zeros((FARTHEST, len(left))), 0.0
    for k, first in enumerate(pairs):
        if len(first) < FEWEST_PAIRS:
            continue
        second = first + k + 1
        alike = np.exp(way[first] - way[second])
        passed = time[second] - time[first]
        passed = passed / max(float(passed.mean()), ABOVE_ZERO) - 1
        of_time = np.vander(passed, TIME_DEGREE + 1)
        alike -= of_time @ np.linalg.lstsq(of_time, alike, rcond=SINGULAR_RATIO)[0]
        total += float(alike @ (left[first] * left[second]))
        weights[k, first] = alike
    power = float((weights**2).sum())
    if power <= 0:
        return 0.0, 0.0
    return total / float(np.sqrt(_variance(weights, noise))), total / power


def _variance(weights: np.ndarray, noise: Noise) -> float:
    """Of Σ w_ki·r_i·r_(i+k) in normal noise of autocovariances C, with weights (k, n) that vary slowly.

    Σ_km Σ_i w_ki·w_mi·(K(m − k) + K(m + k)), K(v) = Σ_u C(u)·C(u + v) (Bartlett 1946; Priestley, Spectral
    Analysis and Time Series (1981), section 5.3.3).
    """
    lag = np.arange(1, FARTHEST + 1)
    apart, together = lag[:, None] - lag, lag[:, None] + lag
    return float(((weights @ weights.T) * (_folded(apart, noise) + _folded(together, noise))).sum())


def _folded(lag: np.ndarray, noise: Noise) -> np.ndarray:
    """Σ_u C(u)·C(u + lag) [arcsec⁴] of white noise and a first-order autoregression, in closed form."""
    rho, far = noise.memory, np.abs(lag)
    alone = noise.white**2 * (lag == 0)
    mixed = 2 * noise.white * noise.coloured * rho**far
    own = noise.coloured**2 * rho**far * (far + (1 + rho**2) / (1 - rho**2))
    return np.asarray(alone + mixed + own)
