"""Test for stick-slip by rests: the residual changes in motion and stays constant while torque rests."""

from __future__ import annotations

import numpy as np
from scipy.special import fdtrc, ndtr

from flexspline.pipeline.diagnosis.measurement.encoder_step import undithered
from flexspline.pipeline.diagnosis.measurement.noise import stretches_of
from flexspline.pipeline.diagnosis.measurement.slow_runs import resting
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.residual.multiple_tests import p_value_of_best
from flexspline.pipeline.diagnosis.sweep.residual.stick_slip_skewness import Jumps

STUCK_BLOCK_ROWS = (1, 2, 4, 8, 16)
"""Rows whose means are compared from block to block: a saw-tooth may be longer than a row."""
FEWEST_STEPS = 10
"""Fewest steps of either kind. A variance of ten steps is known to within a half."""
HOLD_PARTS = 4
"""Parts of a hold. The scatter of their means shows how well the mean of the hold is known."""
FEWEST_STUCK_HOLDS = 4
"""Fewest holds: three degrees of freedom for their scatter."""
EITHER_P_VALUE = 1e-3
"""p-value of each of the two tests: noise slower than a row passes the one by any margin and vibration the
other, so that the other alone must hold them off. With 1e-2 a clean record of 49 was said to stick."""
CORRELATION_FACTOR = 1.5
"""Times the variance of a mean of squared steps: neighbours share a row, 1 + 2·¼ of white noise."""
LEAST_LOG_VARIANCE = 1e-12
"""Least variance of the logarithm of a ratio of squared steps. If all steps are equal, only rounding
scatters."""


def stuck_of(prepared: PreparedSweep, fit: SweepFit) -> Jumps | None:
    """What motion leaves behind where torque rests; None where it never does, or it is no more than noise.

    An output that sticks and breaks away at random stands somewhere else after each way, and stays there
    while torque rests, in a hold or at a turn. Noise in time takes equal steps in holds and between them, and
    vibration of the drive averages out in a hold. Two tests therefore must agree: the steps from block to
    block (variances against each other, in motion and at rest), and the holds' means against what their parts
    leave of doubt (an F-test). The torque's noise is in the angle too; in a hold it is known, up to that of
    the mean, in motion it is not. The rms is the larger of two: that of the holds' means, less this doubt and
    what an encoder rounds; that in motion, less that within holds. A wrong name, such as an error of each
    position, may be fitted to the means of few holds, not to all the motion.
    """
    history, kept = prepared.rig.history, prepared.kept
    still = [rows[kept[rows]] for rows in resting(history)]
    still = [rows for rows in still if len(rows) >= HOLD_PARTS]
    if len(still) < FEWEST_STUCK_HOLDS:
        return None
    left, step = fit.residual(), prepared.sweep.encoder_step_arcsec
    of_torque = (fit.measured_rig().compliance * torque_noise_Nm(history)) ** 2
    p_frozen, variance = _frozen(left, still, step, of_torque)
    hold = np.full(len(kept), -1)
    for number, rows in enumerate(still):
        hold[rows] = number
    p_motion = _moves_more(left[kept], hold[kept], stretches_of(history, kept), step, of_torque)
    if variance <= 0 or max(p_motion, p_frozen) > EITHER_P_VALUE:
        return None
    within = float(np.mean([left[rows].var(ddof=1) for rows in still]))
    moving = float(left[kept & (hold < 0)].var()) - within
    return Jumps(p_frozen * p_motion, float(np.sqrt(max(variance, moving))))


def _frozen(
    left: np.ndarray, still: list[np.ndarray], step: float, of_torque: float
) -> tuple[float, float]:
    """p-value that the holds' means differ as their parts do, and the variance beyond that [arcsec²]."""
    means, within, spread = [], [], []
    for rows in still:
        count = len(rows) // HOLD_PARTS
        parts = left[rows[: count * HOLD_PARTS]].reshape(HOLD_PARTS, count).mean(axis=1)
        means.append(parts.mean())
        within.append(parts.var(ddof=1) / HOLD_PARTS + of_torque / len(rows))
        spread.append(left[rows].var(ddof=1))
    doubt = float(np.mean(within)) + undithered(float(np.mean(spread)), step)
    between = float(np.var(means, ddof=1))
    if doubt <= 0:
        return 1.0, 0.0
    freedom = len(means) - 1, (HOLD_PARTS - 1) * len(means)
    return float(fdtrc(*freedom, between / doubt)), between - doubt


def _moves_more(
    left: np.ndarray, hold: np.ndarray, pieces: list[slice], step: float, of_torque: float
) -> float:
    """p-value that steps between blocks are no larger in motion, of the length that shows it best."""
    ratios = []
    for rows in STUCK_BLOCK_ROWS:
        rest, motion = _steps(left, hold, pieces, rows)
        if min(len(rest), len(motion)) < FEWEST_STEPS:
            continue
        calm, lively = float((rest**2).mean()), float((motion**2).mean())
        calm += 2 * (undithered(rows * calm / 2, step) + of_torque) / rows
        if calm <= 0 or lively <= 0:
            continue
        doubt = CORRELATION_FACTOR * (_spread(rest) / len(rest) + _spread(motion) / len(motion))
        ratios.append(np.log(lively / calm) / np.sqrt(max(doubt, LEAST_LOG_VARIANCE)))
    return p_value_of_best(float(ndtr(-max(ratios))), len(ratios)) if ratios else 1.0


def _steps(
    left: np.ndarray, hold: np.ndarray, pieces: list[slice], rows: int
) -> tuple[np.ndarray, np.ndarray]:
    """Steps between the means of so many rows: within a hold, and all others."""
    rest, motion = [], []
    for s in pieces:
        count = (s.stop - s.start) // rows
        whole = slice(s.start, s.start + count * rows)
        steps = np.diff(left[whole].reshape(count, rows).mean(axis=1))
        each = hold[whole].reshape(count, rows)
        own = np.where((each == each[:, :1]).all(axis=1), each[:, 0], -1)
        same = (own[1:] == own[:-1]) & (own[1:] >= 0)
        rest.append(steps[same])
        motion.append(steps[~same])
    return np.concatenate(rest), np.concatenate(motion)


def _spread(steps: np.ndarray) -> float:
    """Variance of squared steps over their mean's square: 2 of normal ones."""
    squared = steps**2
    return max(float((squared**2).mean() / squared.mean() ** 2) - 1, 0.0) if squared.any() else 0.0
