"""Whether something gives way under torque: a lock, a clamp or a friction joint that slips.

Elastic twist comes back: when torque has risen beyond a share of its largest value and falls below it again,
the angle is where it was, but for the width of a friction loop. A slip stays.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from flexspline.pipeline.diagnosis.measurement.floors import LEAST_ANGLE_ARCSEC
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.structure import Slip

LOADED_SHARE = 0.6
"""Share of the largest torque. Beyond it the gear is loaded, below it the gap is crossed. Judgement."""
MOST_TIMES = 5.0
"""Of the twist between `LOADED_SHARE` and the largest torque: a friction loop as wide as half the whole twist
has 1.25, one as wide as all of it 2.5."""
BACK_RATIO = -1.0
"""Of the same: an angle that goes on under torque one way and comes back under the other is a drift."""
FEWEST_SLIP_ROWS = 3
"""Rows of a load [1]: one more than an outlier may have (`measurement/outliers.py`)."""


def slip_of(history: History, angle_arcsec: np.ndarray) -> Slip | None:
    """The median way that the angle (n,) goes on in the loads of one direction, where something slips."""
    largest = history.largest_Nm
    ways: dict[int, list[float]] = {1: [], -1: []}
    chords: list[float] = []
    for rows in history.unit_slices:
        torque, angle = history.torque_Nm[rows], angle_arcsec[rows]
        side = np.where(np.abs(torque) > LOADED_SHARE * largest, np.sign(torque), 0).astype(int)
        edges = np.flatnonzero(np.diff(np.r_[0, side, 0]))
        loads = [(int(i), int(j)) for i, j in pairwise(edges) if side[i]]
        for i, j in loads[:-1] if loads and loads[-1][1] == len(rows) else loads:
            if j - i >= FEWEST_SLIP_ROWS and i > 0:
                ways[side[i]].append(float(side[i] * (angle[j] - angle[i - 1])))
        for (_, end), (begin, _) in pairwise(loads):
            if side[end - 1] != side[begin]:
                chords.append(abs(float(angle[begin] - angle[end - 1])))
    if not chords or not all(ways.values()):
        return None
    springs = (1 - LOADED_SHARE) / (2 * LOADED_SHARE) * float(np.median(chords))
    up, down = (float(np.median(way)) for way in ways.values())
    times = max(up, down) / max(springs, LEAST_ANGLE_ARCSEC)
    if times < MOST_TIMES or min(up, down) < BACK_RATIO * springs:
        return None
    return Slip(max(up, down), times)
