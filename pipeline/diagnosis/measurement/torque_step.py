"""The step in which a torque is read, where that is coarse."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_noise import (
    COARSE_STEP,
    FEWEST_LEVELS,
    STEP_SHARE,
)

UNEVEN_SHARE = 0.01
"""Of the rows, at which a ramp's pace changes by one step, as rounding makes it: a programme's own steps are
alike along a ramp, and change by more at its ends."""


def torque_step_Nm(history: History) -> float:
    """[N·m]: all readings are whole steps apart; 0 where no such step is seen, or a programme may have it."""
    levels = np.unique(history.torque_Nm)
    if len(levels) < FEWEST_LEVELS or history.readings is not None:
        return 0.0
    apart = np.diff(levels)
    largest = float(np.abs(levels).max())
    last_bit = STEP_SHARE * COARSE_STEP[0] * largest
    apart = apart[apart > last_bit]
    # where a programme repeats, levels may lie 2 and 2.5 N·m apart: of steps of 0.5 N·m
    differ = np.diff(np.unique(apart))
    step = float(np.concatenate([apart, differ[differ > last_bit]]).min())
    alike = np.abs(apart / step - np.round(apart / step)) < STEP_SHARE
    bends = np.concatenate([np.diff(history.torque_Nm[rows], 2) for rows in history.unit_slices])
    uneven = np.abs(np.abs(bends) - step) < step / 2
    coarse = COARSE_STEP[0] * largest < step < COARSE_STEP[1] * largest
    return step if coarse and alike.all() and uneven.sum() > UNEVEN_SHARE * len(history) else 0.0
