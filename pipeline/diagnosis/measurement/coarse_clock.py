"""Times of rows that a clock gives one stamp: whole seconds, with ten rows in each."""

from __future__ import annotations

import numpy as np


def spread_stamps(time_s: np.ndarray, unit: np.ndarray) -> np.ndarray:
    """(n,) times, in order within each unit; rows of one stamp lie evenly in the clock's step after it.

    The step is the least by which the clock moves on. With all rows of a second at its begin, a ramp would
    be stairs.
    """
    spread = time_s.astype(float)
    for u in np.unique(unit):
        rows = np.flatnonzero(unit == u)
        _, first, at, count = np.unique(
            time_s[rows], return_index=True, return_inverse=True, return_counts=True
        )
        if len(count) > 1:
            step = float(np.diff(time_s[rows][first]).min())
            spread[rows] += step * (np.arange(len(rows)) - first[at]) / count[at]
    return spread
