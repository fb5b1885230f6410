"""Where a torque programme changes its rate suddenly: ends of holds, reversals of triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_program import ramp_rate, rates_of

SUDDEN = 0.3
"""Of the ramps' rate, between two neighbouring stretches of a few rows: it is 1 at a hold's ends and 2 at
a triangle's; at a sine's turn half of this, over a sixtieth of the cycle."""
WAY = 4
"""Rows through which a straight way is laid on either side of a corner."""
FEWEST_ROWS_OF_UNIT = 24
"""Of fewer no corner is told from a bend."""


@dataclass(frozen=True)
class Corner:
    """Where torque changes its rate suddenly: by `change`, in shares of the ramps' rate."""

    unit: int
    time_s: float
    change: float


def corners_of(history: History) -> list[Corner]:
    """Corners of the torque's programme: changes of rate beyond `SUDDEN` within a few rows."""
    fast = ramp_rate(history)
    if fast == 0 or history.time_s is None:
        return []
    found = []
    for unit, rows in enumerate(history.unit_slices):
        if len(rows) < FEWEST_ROWS_OF_UNIT:
            continue
        rates = rates_of(history, rows)
        width, time, torque = rates.width, history.time_s[rows], history.torque_Nm[rows]
        change = np.zeros(len(rows))
        change[width:-width] = (rates.values[width:] - rates.values[:-width]) / fast
        found += [
            Corner(unit, _met(time, torque, i, way), float(change[i]))
            for i, way in _ways(_places(change, width), len(rows), max(width, WAY))
        ]
    return found


def _places(change: np.ndarray, width: int) -> list[int]:
    """Rows of the corners, in order.

    A corner is spread over the rows that a rate is taken over, with one sign. A short ramp between two holds
    begins and ends with opposite signs, however near.
    """
    size = np.abs(change)
    taken = {side: np.zeros(len(change), bool) for side in (-1.0, 1.0)}
    found = []
    for i in np.argsort(-size, kind="stable")[: int((size > SUDDEN).sum())]:
        mine = taken[float(np.sign(change[i]))]
        if not mine[i]:
            mine[max(0, i - 2 * width) : i + 2 * width + 1] = True
            found.append(int(i))
    return sorted(found)


def _ways(places: list[int], rows: int, most: int) -> list[tuple[int, int]]:
    """Each corner's row and how many rows on either side have no other corner, `most` at the most."""
    ends = [-1, *places, rows]
    return [(i, min(most, i - ends[k], ends[k + 2] - i - 1)) for k, i in enumerate(places)]


def _met(time_s: np.ndarray, torque_Nm: np.ndarray, i: int, way: int) -> float:
    """Time [s] where the straight ways before and after row i meet, between its neighbours.

    The row's own where the ways are too short to have a slope beyond the torque's noise.
    """
    if way < WAY or i < way or i + way >= len(time_s):
        return float(time_s[i])
    t = time_s - time_s[i]
    (a, b), (c, d) = (
        np.polyfit(t[rows], torque_Nm[rows], 1)
        for rows in (slice(i - way, i), slice(i + 1, i + way + 1))
    )
    if a == c:
        return float(time_s[i])
    return float(time_s[i] + np.clip((d - b) / (a - c), t[i - 1], t[i + 1]))
