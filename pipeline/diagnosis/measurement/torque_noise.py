"""The noise of the torque reading, and what reversals it may make."""

from __future__ import annotations

import numpy as np

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.robust import MAD_PER_SIGMA

DEADBAND_SIGMAS = 2.0
"""Half a reversal that may be noise: two rows of noise differ by more than twice this once in 210 times."""
FEWEST_FOR_NOISE = 8
"""Rows of a unit; of fewer a median of third differences rests on less than five."""
FIFTH_PER_SIGMA = 0.2533
"""What a fifth of |x| lies below for x normal with deviation 1, Φ⁻¹(3/5)."""
LARGEST_NOISE = 0.02
"""Of the largest torque: what looks like more is no noise."""


def deadband_Nm(history: History) -> float:
    """Half the reversal of torque that may be noise: what has a memory is driven without such."""
    return DEADBAND_SIGMAS * torque_noise_Nm(history)


def torque_noise_Nm(history: History) -> float:
    """White noise of the torque reading [N·m].

    The least of three estimates, each too large where its assumption fails: from rows off the straight
    line in time between their neighbours (ramps), from third differences (curved programmes, evenly
    sampled), and from the smallest fifth of the steps between rows (holds).
    """
    key = ("torque_noise", 0.0)
    if key not in history.memo:
        history.memo[key] = _torque_noise_Nm(history)
    return float(history.memo[key])


def _torque_noise_Nm(history: History) -> float:
    found = []
    for rows in history.unit_slices:
        torque = history.torque_Nm[rows]
        if len(torque) < FEWEST_FOR_NOISE:
            continue
        t = history.time_or_rows(rows)
        span = np.maximum(t[2:] - t[:-2], ABOVE_ZERO)
        share = np.clip((t[1:-1] - t[:-2]) / span, 0.0, 1.0)
        off = torque[1:-1] - (1 - share) * torque[:-2] - share * torque[2:]
        line = np.median(np.abs(off) / np.sqrt(1 + share**2 + (1 - share) ** 2)) / MAD_PER_SIGMA
        third = (
            np.median(np.abs(np.diff(torque, 3))) / MAD_PER_SIGMA / np.sqrt(20)
        )  # 1² + 3² + 3² + 1²
        first = np.quantile(np.abs(np.diff(torque)), 0.2) / FIFTH_PER_SIGMA / np.sqrt(2)
        found.append(min(line, third, first))
    largest = float(np.abs(history.torque_Nm).max())
    return min(float(np.median(found)), LARGEST_NOISE * largest) if found else 0.0
