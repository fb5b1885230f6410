"""The noise of the torque reading, and what reversals it may make."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.white_noise import white_noise

DEADBAND_SIGMAS = 2.0
"""Half a reversal that may be noise: two rows of noise differ by more than twice this once in 210 times."""
LARGEST_NOISE = 0.02
"""Of the largest torque: what looks like more is no noise."""


def deadband_Nm(history: History) -> float:
    """Half the reversal of torque that may be noise: what has a memory is driven without such."""
    return DEADBAND_SIGMAS * torque_noise_Nm(history)


def torque_noise_Nm(history: History) -> float:
    """White noise of the torque reading [N·m], the typical unit's."""
    key = ("torque_noise", 0.0)
    if key not in history.memo:
        history.memo[key] = _torque_noise_Nm(history)
    return float(history.memo[key])


def _torque_noise_Nm(history: History) -> float:
    each = (
        white_noise(history.torque_Nm[rows], history.time_or_rows(rows))
        for rows in history.unit_slices
    )
    found = [noise for noise in each if noise is not None]
    largest = float(np.abs(history.torque_Nm).max())
    return min(float(np.median(found)), LARGEST_NOISE * largest) if found else 0.0
