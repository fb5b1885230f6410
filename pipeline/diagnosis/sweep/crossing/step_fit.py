"""Where the gap is crossed, before anything is fitted: what a step at a place and smooth functions leave."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dpotrf, dpotrs

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.pipeline.diagnosis.causes.operators import (
    direction_of_loading,
    steadied,
    stops,
)
from flexspline.pipeline.diagnosis.causes.periodic import KEYS, USUAL, harmonic
from flexspline.pipeline.diagnosis.measurement.floors import ROUNDING_ARCSEC
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_jitter import less_jitter
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm
from flexspline.pipeline.diagnosis.robust import robust_std
from flexspline.pipeline.diagnosis.sweep.nuisance.basis_functions import to_one
from flexspline.pipeline.diagnosis.sweep.nuisance.lagged_torque import lagging_torque

MOST_ZEROS = 40
"""Most cycles of a record in which each cycle has its own zero. With more, each unit has one zero. Judgement:
it limits the columns."""
MOST_FIRST_ROWS = 3000
"""Most rows of a first guess, evenly chosen, so that a longer record takes no longer."""
BESIDE_BAND = 0.3
"""Of the crossing's band, 1.2σ or more of the torque's noise: nearer rows may lie on either side."""
LEAST_STEP = 0.15
"""Least step over the simulated gap. A smaller step is not the gap. Judgement."""
DEPENDENT = 4.0
"""Neighbouring rows that count as one, since a smooth function misses them by the same amount. Judgement."""
SINGULAR_SHARE = 1e-12
"""Of the normal equations' largest eigenvalue: functions that are one but for 1e-6 share their coefficient.
The equations take a fifth of the time of a decomposition of 3000 rows, and a guess needs no more digits."""
REGULAR_SHARE = 1e-4
"""Of a Cholesky factor's largest pivot: where none is smaller, no eigenvalue is near `SINGULAR_SHARE`, as
eigenvalues are like squares of pivots. The factor then gives the same coefficients in a tenth of the time."""
ROBUST_DEVIATIONS = 4.0
"""Standard deviations: beyond, a row weighs less (Huber's weights); of normal noise, one row in 16 000."""
CONSTANT_SHARE = 1e-12
"""Of a cycle's number, or K: a temperature that does not change is off its mean by rounding, some 1e-14."""

TRIED_THRESHOLDS = (0.04, 0.12, 0.3)
"""Thresholds of ordinary friction that are fitted at every place tried, so that only the step decides.
Judgement."""


def looped_functions(history: History) -> np.ndarray:
    """(n, k) `unlooped_functions`, friction elements, lags."""
    largest = history.largest_Nm
    limits = np.array(TRIED_THRESHOLDS) * largest
    torque = steadied(history, deadband_Nm(history))
    beside = stops(history, torque, limits, np.zeros(len(limits))) / limits
    direction, lagging = direction_of_loading(history), lagging_torque(history) / largest
    return np.column_stack([unlooped_functions(history), direction, beside, lagging])


def unlooped_functions(history: History) -> np.ndarray:
    """(n, k) zeros, a stiffness of each position, smooth functions of torque.

    Of the torque without its noise: a lag is smoother than the reading, and would stand in for it.
    """
    x = less_jitter(history).torque_Nm / history.largest_Nm
    zeros, positions = zeros_of_cycles(history), stiffness_of_positions(history)
    return np.column_stack([*zeros, positions, x, np.abs(x), x * np.abs(x), x**3])


def zeros_of_cycles(history: History) -> list[np.ndarray]:
    """Columns (n,): a zero for each cycle, as position errors and drift would else hide the step.

    And what a drift does within a cycle: where time is recorded, it and its root, counted in each unit.
    """
    cycles = history.cycle_slices
    if len(cycles) > MOST_ZEROS:
        cycles = history.unit_slices
    every = np.arange(len(history))
    zeros = [np.isin(every, rows).astype(float) for rows in cycles]
    if history.time_s is None:
        return zeros
    passed = np.zeros(len(history))
    for rows in history.unit_slices:
        t = history.time_s[rows]
        passed[rows] = (t - t[0]) / max(float(np.ptp(t)), ABOVE_ZERO)
    return [*zeros, passed, np.sqrt(passed)]


def stiffness_of_positions(history: History) -> np.ndarray:
    """(n, 6) torque times the harmonics 1, 2 and 4 of the wave generator's angle, where it is recorded.

    A stiffness that differs from cycle to cycle would else hide the step.
    """
    if history.input_angle_deg is None:
        return np.empty((len(history), 0))
    shape = dict(zip(KEYS, map(float, USUAL), strict=True))
    largest = history.largest_Nm
    return harmonic(shape, history) * (history.torque_Nm / largest)[:, None]


def changing_heights(history: History) -> np.ndarray:
    """(n, m) by what the gap may change, each of mean 0: the cycle, and the temperature where it is recorded.

    A gap that wears or warms has another step in each cycle, and none of one height fits.
    """
    changing = [history.cycle.astype(float)]
    if history.temperature_C is not None:
        changing.append(history.temperature_C)
    columns = np.column_stack(changing)
    return to_one(columns - columns.mean(axis=0), CONSTANT_SHARE)


@dataclass(frozen=True)
class StepFit:
    """What is fitted to a record's angle beside a step of the gap, wherever the step is.

    Attributes
    ----------
    smooth : (n, k) functions. angle_arcsec : (n,). band_Nm : half width of the gap's crossing.
    heights : (n, m), each of mean 0: what the step's height may also be in proportion to.
    """

    smooth: np.ndarray
    angle_arcsec: np.ndarray
    gap_arcsec: float
    band_Nm: float
    heights: np.ndarray | None = None

    def misfit(self, beyond_Nm: np.ndarray, least: float = LEAST_STEP) -> float:
        """Sum of squares [arcsec²] that the functions and a step leave; infinite without a step.

        Rows so near the step that they may lie on either side count as the mean of the others: else a place
        that many rows are near would have the least.

        `beyond_Nm` (n,) is how far the torque of each row lies beyond the step's place. The step's height is
        free, but one below `least` times the gap is none.
        """
        looked = np.arange(0, len(beyond_Nm), max(1, len(beyond_Nm) // MOST_FIRST_ROWS))
        rows = looked[np.abs(beyond_Nm[looked]) > BESIDE_BAND * self.band_Nm]
        basis, angle_arcsec = self._basis(rows, np.sign(beyond_Nm[rows])), self.angle_arcsec[rows]
        weight = np.ones(len(rows))
        left = angle_arcsec
        for _ in range(2):
            coefficients = weighted_fit(basis, angle_arcsec, weight)
            left = angle_arcsec - basis @ coefficients
            scale = robust_std(left) + ROUNDING_ARCSEC
            weight = 1 / np.maximum(1, np.abs(left) / (ROBUST_DEVIATIONS * scale))
        if coefficients[-1] < least * self.gap_arcsec:
            return np.inf
        return float(np.mean(np.minimum(np.abs(left), 2 * self.gap_arcsec) ** 2)) * len(looked)

    def _basis(self, rows: np.ndarray, side: np.ndarray) -> np.ndarray:
        """(r, k + m + 1) of some rows, the last the step, on whose `side` (r,) each lies."""
        if self.heights is None:
            return np.column_stack([self.smooth[rows], side])
        return np.column_stack([self.smooth[rows], self.heights[rows] * side[:, None], side])


def weighted_fit(basis: np.ndarray, values: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Coefficients (k,) of the functions (n, k) that are nearest to values (n,), each row weighted (n,)."""
    weighted = basis * weight[:, None]
    matrix, right = weighted.T @ weighted, weighted.T @ (values * weight)
    factor, failed = dpotrf(matrix, lower=True)
    pivots = np.diag(factor)
    if failed == 0 and pivots.min() > REGULAR_SHARE * pivots.max():
        return np.asarray(dpotrs(factor, right, lower=True)[0])
    return np.asarray(np.linalg.lstsq(matrix, right, rcond=SINGULAR_SHARE)[0])


def nats_over(at_zero: float, best: float, rows: int) -> float:
    """What a step elsewhere gains over one at zero torque, of `rows` rows of a record."""
    return rows_judged(rows) / 2 * float(np.log(at_zero / best)) / DEPENDENT


def rows_judged(rows: int) -> float:
    """How many of a record's `rows` a first guess looks at, about."""
    return rows / max(1, rows // MOST_FIRST_ROWS)
