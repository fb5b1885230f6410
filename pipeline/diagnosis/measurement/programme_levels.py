"""Levels at which a torque programme rests repeatedly: a rig's weights, a controller's set points."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.known_ways import known_ways
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.measurement.torque_jitter import less_jitter

ONE_LEVEL, WIDEST_LEVEL = 4.0, 8.0
"""Deviations between two rests at one level, and between the lowest and the highest of many: further apart
they are levels of their own, or a programme that never comes back."""


@once
def levelled_torque_Nm(history: History) -> np.ndarray:
    """(n,) torque less its noise; rests at one level have the mean of all of them.

    Each rest's own mean is off by its noise, which is in the angle too: a wave over the torque that passes
    through zero at every level would tell them apart by that alone.
    """
    torque = less_jitter(history).torque_Nm.copy()
    rests = [way for way in known_ways(history) if way.held]
    if len(rests) < 2:
        return torque
    mean = np.array([torque[rest.rows].mean() for rest in rests])
    doubt = np.array([np.abs(rest.doubt_Nm).max() for rest in rests])
    order = np.argsort(mean)
    apart = np.diff(mean[order]) > ONE_LEVEL * np.hypot(doubt[order[1:]], doubt[order[:-1]])
    for level in np.split(order, np.flatnonzero(apart) + 1):
        if np.ptp(mean[level]) < WIDEST_LEVEL * np.sqrt(2) * doubt[level].max():
            rows = np.concatenate([rests[i].rows for i in level])
            torque[rows] = torque[rows].mean()
    return torque
