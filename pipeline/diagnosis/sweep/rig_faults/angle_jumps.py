"""Whether an angle leaps: from one row to the next by many times what it moves in most, and with the torque.

In a record of few rows, each a step of the torque, nothing else tells this from noise, which goes either way.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.shortage import Leaps

LEAP_RATIO = 10.0
"""Times the median move between two rows: of normal noise one move in 70 billion goes so far."""
FEWEST_LEAPS = 3
"""Fewest leaps, all in the torque's direction. A single one may be a touch of the rig; spikes go there and
back."""


def leaps_of(history: History, angle_arcsec: np.ndarray) -> Leaps | None:
    """The leaps of an angle (n,); None where it does not leap, or not with the torque."""
    moves, torques = [], []
    for rows in history.unit_slices:
        step = np.diff(history.torque_Nm[rows])
        moves.append(np.diff(angle_arcsec[rows]) * np.sign(step))
        torques.append(history.torque_Nm[rows[1:]])
    move, torque = np.concatenate(moves), np.concatenate(torques)
    usual = float(np.median(np.abs(move))) if len(move) else 0.0
    far = np.abs(move) > LEAP_RATIO * usual
    if usual == 0 or far.sum() < FEWEST_LEAPS or (move[far] < 0).any():
        return None
    size, at = move[far], torque[far]
    return Leaps(
        len(size), (float(size.min()), float(size.max())), (float(at.min()), float(at.max())), usual
    )
