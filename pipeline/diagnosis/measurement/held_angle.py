"""Rows that repeat the angle of the row before: a channel that is read more slowly than rows are written.

Torque goes on meanwhile, and the angle seems to stay behind it, as with friction or a lag.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.encoder_step import encoder_step
from flexspline.pipeline.diagnosis.measurement.table import MeasuredTable

FEWEST_READINGS = 20
"""Fewest readings of a unit. With fewer, no regularity is visible. Judgement."""
MOST_ROWS = 10
"""Most rows with one reading. An angle that stays constant for longer is held by the rig. Judgement."""
REGULAR_SHARE = 0.8
"""Share of the readings that stay as long as the typical one, within one row, because two clocks are not
synchronous."""
FEWEST_STEPS = 3.0
"""Fewest encoder steps from one reading to the next. With fewer, the encoder is coarse and the channel need
not be slow."""
LEAST_PROGRESS = 0.5
"""Of the torque's way from one reading to the next, what it has gone while the first one stays, over what it
would at an even pace: on a staircase it stays as the angle does."""


def held_rows(table: MeasuredTable) -> np.ndarray:
    """(n,) rows of a sweep whose angle is the one before, where its channel is slow; each unit by itself."""
    held = np.zeros(len(table), bool)
    for rows in table.unit_rows():
        held[rows] = _held(table.numbers["torque_Nm"][rows], table.numbers["angle_arcsec"][rows])
    return held


def _held(torque_Nm: np.ndarray, angle_arcsec: np.ndarray) -> np.ndarray:
    repeats = np.r_[False, np.diff(angle_arcsec) == 0]
    first = np.flatnonzero(~repeats)
    none = np.zeros(len(repeats), bool)
    if len(first) < FEWEST_READINGS + 1:
        return none
    lengths = np.diff(first)  # of all readings but the last
    usual = float(np.median(lengths))
    if not 2 <= usual <= MOST_ROWS or np.mean(np.abs(lengths - usual) <= 1) < REGULAR_SHARE:
        return none
    rise = float(np.median(np.abs(np.diff(angle_arcsec[first]))))
    if rise <= FEWEST_STEPS * encoder_step(angle_arcsec):
        return none
    way = float(np.median(np.abs(np.diff(torque_Nm[first]))))
    within = float(np.median(np.abs(torque_Nm[first[1:] - 1] - torque_Nm[first[:-1]])))
    goes_on = within > LEAST_PROGRESS * way * (usual - 1) / usual
    return repeats if goes_on else none
