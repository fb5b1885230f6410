"""The closed loop of angle over torque that friction makes, and how wide it is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History

LOOP_ROWS = 201
"""Rows of a branch from end to end. Torques are then 1 % of the largest apart. The number is odd, so that one
torque is 0."""
MIDDLE_ROW = LOOP_ROWS // 2
"""Row of such a branch with T = 0."""


def loop_widths(angle: Callable[[History], np.ndarray], largest_Nm: float) -> np.ndarray:
    """(LOOP_ROWS,) unloading less loading angle, from −T to T, in the unit of `angle`.

    Torque goes to and fro twice, because the first loop still depends on the state before it.
    """
    up = np.linspace(-largest_Nm, largest_Nm, LOOP_ROWS)
    twist = angle(History.course(np.concatenate([up, up[::-1], up, up[::-1]])))
    loading, unloading = twist[2 * LOOP_ROWS : 3 * LOOP_ROWS], twist[3 * LOOP_ROWS :]
    return np.asarray(unloading[::-1] - loading)
