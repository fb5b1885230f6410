"""Where a torque programme changes its rate suddenly: ends of holds, reversals of triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.measurement.floors import LEAST_TIME_S
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_rate, rates_of
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm

SUDDEN = 0.3
"""Change of rate at a corner between two neighbouring stretches of a few rows, over the ramps' rate. It is 1
at a hold's ends and 2 at a triangle's; at a sine's turn it is half of this limit over a sixtieth of the
cycle."""
LONGEST_PARTS = 30
"""Of a cycle: from one such part to the next a sine changes its rate by 2π/30 = 0.21 of its fastest, below
`SUDDEN`."""
CORNER_SIGMAS = 4.5
"""Standard deviations of a change by the torque's noise. Noise alone exceeds it in one row of 150 000."""
MET_WIDTHS = 3
"""Times the rows of a rate, through which the ways beside a corner are laid. With 1 % of noise and 1500 rows
a cycle they meet within two rows of the corner; ways of a rate's own rows meet up to 17 away."""
ROWS_BESIDE_CORNER = 4
"""Fewest rows of a straight line on either side of a corner. Judgement: two degrees of freedom are left."""
FEWEST_ROWS_OF_UNIT = 24
"""Fewest rows of a unit. With fewer, a corner cannot be told from a bend. Judgement."""


@dataclass(frozen=True)
class TorqueCorner:
    """Where torque changes its rate suddenly: by `change`, in shares of the ramps' rate."""

    unit: int
    time_s: float
    change: float


def corners_of(history: History) -> list[TorqueCorner]:
    """Corners of the torque's programme: changes of rate beyond `SUDDEN` and noise within a few rows."""
    fast = ramp_rate(history)
    if fast == 0 or history.time_s is None:
        return []
    corners = []
    for unit, rows in enumerate(history.unit_slices):
        if len(rows) < FEWEST_ROWS_OF_UNIT:
            continue
        time, torque = history.time_s[rows], history.torque_Nm[rows]
        noise = torque_noise_Nm(history, rows) / fast
        width = rates_of(history, rows).width
        cycle = len(rows) / (int(history.cycle[rows].max()) + 1)
        longest = max(width, int(cycle / LONGEST_PARTS))
        widths = sorted({min(w, longest) for w in (width, 2 * width, 4 * width)})
        change = _sudden(time, torque / fast, noise, widths, cycle)
        most = max(MET_WIDTHS * width, ROWS_BESIDE_CORNER)
        corners += [
            TorqueCorner(unit, _met(time, torque, i, way), float(change[i]))
            for i, way in _ways(np.flatnonzero(change).tolist(), len(rows), most)
        ]
    return corners


def _sudden(
    time_s: np.ndarray, torque_s: np.ndarray, noise_s: float, widths: list[int], cycle: float
) -> np.ndarray:
    """(n,) sudden changes of rate, 0 at all other rows; torque and its noise in seconds of the ramps' rate.

    Over more rows smaller changes stand out of the noise, beyond what a sine of so many rows a `cycle` does.
    A corner is spread over the rows that a rate is taken over, with one sign. A short ramp between two holds
    begins and ends with opposite signs, however near.
    """
    largest_change = np.zeros(len(time_s))
    for width in widths:
        taken = {side: np.zeros(len(time_s), bool) for side in (-1.0, 1.0)}
        for i in np.flatnonzero(largest_change):
            taken[float(np.sign(largest_change[i]))][max(0, i - 2 * width) : i + 2 * width + 1] = (
                True
            )
        span = np.maximum(time_s[width:] - time_s[:-width], LEAST_TIME_S)
        rate = (torque_s[width:] - torque_s[:-width]) / span
        change, doubt = np.zeros(len(time_s)), np.full(len(time_s), np.inf)
        change[width:-width] = rate[width:] - rate[:-width]
        before, after = 1 / span[:-width], 1 / span[width:]
        doubt[width:-width] = noise_s * np.sqrt(before**2 + after**2 + (before + after) ** 2)
        smooth = 2 * np.pi * width / cycle
        clear = np.flatnonzero(np.abs(change) > np.maximum(SUDDEN, smooth + CORNER_SIGMAS * doubt))
        for i in clear[np.argsort(-np.abs(change[clear]), kind="stable")]:
            mine = taken[float(np.sign(change[i]))]
            if not mine[i]:
                mine[max(0, i - 2 * width) : i + 2 * width + 1] = True
                largest_change[i] = change[i]
    return largest_change


def _ways(places: list[int], rows: int, most: int) -> list[tuple[int, int]]:
    """Each corner's row and how many rows on either side have no other corner, `most` at the most."""
    ends = [-1, *places, rows]
    return [(i, min(most, i - ends[k], ends[k + 2] - i - 1)) for k, i in enumerate(places)]


def _met(time_s: np.ndarray, torque_Nm: np.ndarray, i: int, way: int) -> float:
    """Time [s] where the straight ways before and after a corner near row i meet.

    The row's own where the ways are too short to have a slope beyond the torque's noise, or have one time by
    a clock that counts whole seconds. Where they meet beyond a neighbour, the ways part there: noise moves
    the row of the largest change.
    """
    first = i
    while True:
        met_s = _met_at(time_s, torque_Nm, i, way)
        nearer = i + int(met_s >= time_s[min(i + 1, len(time_s) - 1)]) - int(met_s <= time_s[i - 1])
        if abs(nearer - first) <= abs(i - first) or abs(nearer - first) > way // 2:
            return met_s
        i = nearer


def _met_at(time_s: np.ndarray, torque_Nm: np.ndarray, i: int, way: int) -> float:
    """Time [s] where the ways that part at row i meet, between its neighbours."""
    if way < ROWS_BESIDE_CORNER or i < way or i + way >= len(time_s):
        return float(time_s[i])
    t = time_s - time_s[i]
    ways = slice(i - way, i), slice(i + 1, i + way + 1)
    if any(np.ptp(t[rows]) == 0 for rows in ways):
        return float(time_s[i])
    (a, b), (c, d) = (_line(t[rows], torque_Nm[rows]) for rows in ways)
    if a == c:
        return float(time_s[i])
    return float(time_s[i] + np.clip((d - b) / (a - c), t[i - 1], t[i + 1]))


def _line(t: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Slope and value at 0 of the nearest straight line (`np.polyfit` takes ten times as long)."""
    middle, mean = float(t.sum()) / len(t), float(values.sum()) / len(t)
    off = t - middle
    slope = float(off @ values) / float(off @ off)
    return slope, mean - slope * middle
