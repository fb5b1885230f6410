"""Torques that stand out in a row or two while the angle does not follow: they did not act on the gear.

A motor switches beside the load cell's cable, say. Whatever has a memory would remember such a torque.
"""

from __future__ import annotations

import numpy as np

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.pipeline.diagnosis.measurement.outliers import LONGEST_OUTLIER
from flexspline.pipeline.diagnosis.measurement.runs import runs
from flexspline.pipeline.diagnosis.robust import robust_std

SPIKE_SIGMAS, SPIKE_SHARE, SPIKE_STEPS = 10.0, 0.05, 4.0
"""What a torque must stand out by, to be no torque where the angle does not follow: in deviations of the rows
about it, as a share of the largest torque, and in steps between the rows beside it."""
LARGEST_QUANTILE = 0.95
"""Of torques without sign, taken for the largest: spikes in up to a twentieth of the rows do not count."""
LEAST_TWIST_SHARE = 0.25
"""Least share of the twist that such a torque would cause. If the angle moves by less, it does not follow.
Judgement."""
ROWS_BESIDE = 3
"""Rows on either side that are compared. Judgement."""
ROWS_LATE = 2
"""Rows by which two channels of a logger may be out of step. Judgement."""


def torque_spikes(torque: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """(n,) torques, one or two in a row, that stand out and that the angle does not follow: a gear would."""
    if len(torque) <= 2 * ROWS_BESIDE:
        return np.zeros(len(torque), bool)
    off, moved = (values - _median_about(values) for values in (torque, angle))
    sigma = robust_std(off)
    largest = np.quantile(np.abs(torque), LARGEST_QUANTILE)
    far = np.abs(off) > np.maximum(SPIKE_SIGMAS * sigma, SPIKE_SHARE * largest)
    least_moved = LEAST_TWIST_SHARE * _softness(torque, angle) * np.abs(off)
    spikes = far & (_largest_about(np.abs(moved)) < least_moved)
    for a, b in runs(spikes):
        sides = torque[max(0, a - ROWS_BESIDE) : a], torque[b : b + ROWS_BESIDE]
        step = max((np.abs(np.diff(side)).max(initial=0.0) for side in sides), default=0.0)
        alone = b - a <= LONGEST_OUTLIER
        spikes[a:b] = alone and np.abs(off[a:b]).min() > SPIKE_STEPS * step
    return spikes


def _softness(torque: np.ndarray, angle: np.ndarray) -> float:
    """Angle per torque beside the gap: the smaller slope of the two sides."""
    slopes = []
    for side in (torque > 0, torque < 0):
        off = torque[side] - torque[side].mean() if side.any() else np.zeros(0)
        slopes.append(float(off @ angle[side]) / max(float(off @ off), ABOVE_ZERO))
    return max(min(slopes), 0.0)


def _largest_about(values: np.ndarray) -> np.ndarray:
    """(n,) largest of each row and `ROWS_LATE` on either side."""
    padded = np.pad(values, ROWS_LATE, mode="edge")
    return np.asarray(
        np.lib.stride_tricks.sliding_window_view(padded, 2 * ROWS_LATE + 1).max(axis=1)
    )


def _median_about(values: np.ndarray) -> np.ndarray:
    """(n,) medians of each row and two on either side."""
    padded = np.pad(values, 2, mode="edge")
    return np.asarray(np.median(np.lib.stride_tricks.sliding_window_view(padded, 5), axis=1))
