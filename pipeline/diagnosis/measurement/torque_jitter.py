"""The noise of a torque reading, row by row: the residual of a parabola through the neighbouring rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.measurement.floors import LEAST_TIME_S
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.known_ways import known_ways, programme_edges
from flexspline.pipeline.diagnosis.measurement.lost_turns import turning_like
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.measurement.torque_noise import (
    noise_of_usual_rows_Nm,
    torque_noise_of_rows_Nm,
)
from flexspline.pipeline.diagnosis.robust import rms

FAR_SIGMAS = 4.0
"""Standard deviations of the torque noise; one row of noise in 16 000 lies further off."""
USUAL_ROWS, WIDEST_ROWS = 7, 20
"""Rows on either side: torque within 15 is known to 0.39 of its noise, its rate to 0.06 a row; of 41 to
0.23."""
NOISE_LEFT = 0.25
"""Share of the noise that is left where it is taken off: 0.39 within a way, 0.26 in the mean of 15 rows."""
CYCLE_PART = 40
"""Of a cycle, on either side: of a sine a parabola there leaves (2π/40)⁴/24 of its height at most, 3e-5."""
PARABOLA_MIDDLE = 1.5
"""Of a parabola through n rows the middle has this share of their noise, over √n: √(9/4)."""
RIDGE = 1e-12
"""Beside a parabola's equations, whose diagonal is 1 and more: rows of one time have some solution then."""
FEWEST_STRAIGHT_ROWS = 4
"""Fewest rows of a straight way. A parabola fits three rows exactly."""


READING = ("reading", 0.0)
"""Key of the reading whose noise a history's torque has."""


def behind(reading: History, carried_Nm: np.ndarray) -> History:
    """The history with the torque that is left behind friction: its noise is the reading's, row by row."""
    turned = turning_like(reading, replace(reading, torque_Nm=reading.torque_Nm - carried_Nm))
    turned.memo[READING] = reading
    return turned


def reading_of(history: History) -> History:
    """The reading whose noise a history's torque has: its own, but for `behind`."""
    reading: History = history.memo.get(READING, history)
    return reading


def jitter(history: History, width: int) -> np.ndarray:
    """(n,) torque less a parabola through `width` rows on either side: its noise, and little else.

    No parabola reaches over a corner of the programme (`corners.py`): it would leave the corner there. Beside
    one, and at the record's ends, as many rows lie on one side. Of a hold between corners it is the torque
    less its mean.
    """
    return _jitter_of_reading(reading_of(history), width)


@once
def _jitter_of_reading(history: History, width: int) -> np.ndarray:
    own = torque_noise_of_rows_Nm(history)
    out = np.zeros(len(history))
    if not own.any():  # a calculated course
        return out
    for rows, edges in zip(history.unit_slices, programme_edges(history), strict=True):
        t = history.time_or_rows(rows)
        out[rows] = _off_parabolas(history.torque_Nm[rows], t, edges, width)
    for way in known_ways(history):
        if way.held or width >= widest(history):
            out[way.rows] = way.noise_Nm
    # beyond its noise it is a corner that was not seen
    return np.where(np.abs(out) < FAR_SIGMAS * own, out, 0.0)


def widest(history: History) -> int:
    """Rows on either side that many rows a cycle allow."""
    return int(np.clip(len(history) / history.cycle_count / CYCLE_PART, USUAL_ROWS, WIDEST_ROWS))


@once
def less_jitter(history: History) -> History:
    """The history with its torque less the noise, as far as the rows around each one know it."""
    torque = history.torque_Nm - jitter(history, widest(history))
    cleared = turning_like(history, replace(history, torque_Nm=torque))
    noise_of_usual_rows_Nm.keep(cleared, np.full(len(history), _left_Nm(reading_of(history))))
    return cleared


@once
def by_known_ways(history: History) -> np.ndarray:
    """(n,) torque less the noise of ways that few numbers tell; elsewhere as it is read.

    For bent curves of torque: what a parabola leaves of the noise, alike in many rows, would look like one.
    """
    torque = history.torque_Nm.copy()
    for way in known_ways(reading_of(history)):
        torque[way.rows] -= way.noise_Nm
    return torque


@once
def _left_Nm(history: History) -> float:
    """Noise [N·m] that a typical row has without its jitter: it is alike in neighbours, so none sees it."""
    rows = 2 * widest(history) + 1
    left = PARABOLA_MIDDLE / np.sqrt(rows) * torque_noise_of_rows_Nm(history)
    for way in known_ways(history):
        left[way.rows] = np.sqrt((way.doubt_Nm**2).sum(axis=1))
    return rms(left)


def _off_parabolas(torque: np.ndarray, t: np.ndarray, edges: np.ndarray, width: int) -> np.ndarray:
    """(n,) torque less parabolas over windows that keep between the edges (m,), rows of ways' first ones."""
    n = len(t)
    way = np.searchsorted(edges, np.arange(n), side="right") - 1
    first, last = edges[way], edges[way + 1]
    start = np.clip(np.arange(n) - width, first, np.maximum(last - 2 * width - 1, first))
    near = start[:, None] + np.arange(2 * width + 1)
    inside = near < last[:, None]
    near = np.minimum(near, n - 1)
    x = t[near] - t[:, None]
    x /= np.maximum(np.abs(np.where(inside, x, 0.0)).max(axis=1, keepdims=True), LEAST_TIME_S)
    basis = np.stack([np.ones_like(x), x, x * x], axis=2) * inside[:, :, None]
    gram = np.einsum("nwi,nwj->nij", basis, basis) + RIDGE * np.eye(3)
    right = np.einsum("nwi,nw->ni", basis, torque[near])
    off = torque - np.linalg.solve(gram, right[:, :, None])[:, 0, 0]
    return np.where(last - first < FEWEST_STRAIGHT_ROWS, 0.0, off)
