"""Rows that a record has lost: a logger that paused, rows that somebody deleted."""

from __future__ import annotations

import numpy as np

USUAL_QUANTILE, LOST_STEPS = 0.95, 4.0
"""Quantile of the steps of time from one row to the next, and how many times that others are missing between
two rows: of steps at random, which are exponential, one in 160 000 is as long."""
LOST_SHARE = 0.5
"""Share of the travel of torque. If more of it lies between rows that are far apart, the logger writes only
changes."""


def far_apart(t: np.ndarray, torque_Nm: np.ndarray, step: int) -> np.ndarray:
    """Rows (k,) of one unit after which the next is far away, of rows at random times too.

    Parameters: times (n,) and torques (n,); and over how many rows, a `step`, the travel is taken.
    """
    return _after(t, torque_Nm, step, 0.5)


def losses(t: np.ndarray, torque_Nm: np.ndarray) -> np.ndarray:
    """Rows (k,) of one unit after which others are missing; of times (n,) and torques (n,)."""
    return _after(t, torque_Nm, 1, USUAL_QUANTILE)


def _after(t: np.ndarray, torque_Nm: np.ndarray, step: int, quantile: float) -> np.ndarray:
    """Rows before a step of time beyond `LOST_STEPS` times that quantile of all."""
    spans = np.diff(t)
    usual = np.quantile(spans, quantile) if len(spans) else 0.0
    if usual <= 0:  # a clock of whole seconds
        return np.zeros(0, int)
    lost = spans > LOST_STEPS * usual
    travel = np.abs(np.diff(torque_Nm[::step])).sum()
    missing = np.abs(np.diff(torque_Nm))[lost].sum()
    return np.flatnonzero(lost) if missing <= LOST_SHARE * travel else np.zeros(0, int)
