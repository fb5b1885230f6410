"""The resolution of the torque reading, if it is coarse."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_noise import (
    COARSE_STEP,
    FEWEST_LEVELS,
    STEP_SHARE,
    are_coarse,
    second_differences_Nm,
)

UNEVEN_SHARE = 0.01
"""Share of the rows at which a ramp's pace changes by one step, as by rounding. A programme's own steps are
equal along a ramp, and change by more at its ends. Judgement."""


def torque_step_Nm(history: History) -> float:
    """[N·m]: all readings are whole steps apart; 0 where no such step is seen, or a programme may have it."""
    levels = np.unique(history.torque_Nm)
    if len(levels) < FEWEST_LEVELS or history.readings is not None:
        return 0.0
    apart = np.diff(levels)
    largest = history.largest_Nm
    last_bit = STEP_SHARE * COARSE_STEP[0] * largest
    apart = apart[apart > last_bit]
    # where a programme repeats, levels may lie 2 and 2.5 N·m apart: of steps of 0.5 N·m
    differ = np.diff(np.unique(apart))
    step = float(np.concatenate([apart, differ[differ > last_bit]]).min())
    uneven = (np.abs(np.abs(second_differences_Nm(history)) - step) < step / 2).sum()
    seen = uneven > UNEVEN_SHARE * len(history) and are_coarse(apart, step, largest)
    return step if seen else 0.0
