"""Torques at which a record turned while no row was written."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.known_ways import programme_edges
from flexspline.pipeline.diagnosis.measurement.lost_rows import losses
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.robust import rms

WAY_ROWS, FEWEST_ROWS = 60, 8
"""Of a straight way on either side, the nearest: most, and fewest."""
AT_CORNER = 3
"""Rows by which a way's other end may be misplaced."""
STRAIGHT = 0.01
"""Of the torque along it, what a straight way's rms may be off a line beyond twice its noise: that of a sine
from its top over an eighth of the cycle is 0.06."""


def turned_unseen(history: History) -> np.ndarray:
    """(n,) torque [N·m], at the row before a loss of rows that of the turn that was lost with them.

    For what has a memory: it is driven to the turn, though nobody has written it. The straight ways on either
    side are followed to where they meet.
    """
    key = ("turned_unseen", 0.0)
    if key not in history.memo:
        history.memo[key] = _turned_unseen(history)
    found: np.ndarray = history.memo[key]
    return found


def _turned_unseen(history: History) -> np.ndarray:
    torque = history.torque_Nm
    if history.time_s is None or history.exact:
        return torque
    lost = {
        unit: losses(history.time_s[rows], torque[rows])
        for unit, rows in enumerate(history.unit_slices)
    }
    if not any(map(len, lost.values())):
        return torque
    torque = torque.copy()
    for (unit, rows), edges in zip(
        enumerate(history.unit_slices), programme_edges(history), strict=True
    ):
        for (first, turn), (_, last) in pairwise(pairwise(edges.tolist())):
            if turn - 1 in lost[unit]:
                before = rows[max(first + AT_CORNER, turn - WAY_ROWS) : turn]
                after = rows[turn : min(last - AT_CORNER, turn + WAY_ROWS)]
                met = _met(history, before, after)
                torque[rows[turn - 1]] = met if met is not None else torque[rows[turn - 1]]
    return torque


def _met(history: History, before: np.ndarray, after: np.ndarray) -> float | None:
    """Torque [N·m] where two straight ways meet between their rows; None where they do not, or go on."""
    assert history.time_s is not None
    if min(len(before), len(after)) < FEWEST_ROWS:
        return None
    lines = []
    for rows in (before, after):
        t, torque = history.time_s[rows] - history.time_s[before[-1]], history.torque_Nm[rows]
        line = np.polynomial.Polynomial.fit(t, torque, 1).convert()
        if rms(torque - line(t)) > 2 * torque_noise_Nm(history) + STRAIGHT * np.ptp(torque):
            return None
        lines.append(line)
    (level, slope), (later, back) = (np.pad(line.coef, (0, 2 - len(line.coef))) for line in lines)
    if slope * back >= 0:
        return None
    at = (later - level) / (slope - back)
    inside = 0 < at < history.time_s[after[0]] - history.time_s[before[-1]]
    return float(level + slope * at) if inside else None
