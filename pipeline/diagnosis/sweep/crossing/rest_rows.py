"""Rows of a hold: one true torque, read many times.

A rig that rests without torque between its cycles stands on one side of the gap. If each of its rows had a
torque of its own, as many on that side would put the crossing beyond all of them, by deviations of the noise.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import holds


def holds_as_one(
    history: History, values: np.ndarray, rows: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(m, c) of the `values` (n, c) in some rows (k,), one for each hold; and of how many rows each is.

    Of the first value, the torque, a hold has the mean; of the others the median, as a row at its end may
    belong to the move beside it.
    """
    given = np.zeros(len(history), bool)
    given[rows] = True
    parts = [hold[given[hold]] for hold in holds(history)]
    parts = [part for part in parts if len(part)]
    for part in parts:
        given[part] = False
    held = [[values[part, 0].mean(), *np.median(values[part, 1:], axis=0)] for part in parts]
    counts = np.r_[np.ones(given.sum()), [float(len(part)) for part in parts]]
    return np.vstack([values[given], *held]), counts
