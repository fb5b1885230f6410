"""Operators on a history that several causes need: friction elements and lags."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.pipeline.diagnosis.measurement.floors import LEAST_TORQUE_Nm
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.lost_turns import turned_unseen
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.measurement.recursion import first_order
from flexspline.pipeline.diagnosis.measurement.torque_noise import LARGEST_NOISE

LEAST_TO_COME = 1e-12
"""Least share of the largest friction that is still to come, or of a power of that share. It keeps powers and
roots from overflowing."""


def stops(
    history: History, torque_Nm: np.ndarray, thresholds_Nm: np.ndarray, start: np.ndarray
) -> np.ndarray:
    """(n, m) states of elastic-perfectly plastic elements, each driven by `torque_Nm` (n,).

    s_i = clip(s_{i−1} + T_i − T_{i−1}, −r, r), from s = start·r before each unit's first row's T = 0.
    Rate-independent: only the order of torques counts.

    Parameters: thresholds r (m,) [N·m], start (m,) in −1…1. Source: Krasnosel'skii, Pokrovskii,
    Systems with Hysteresis (1989), section 2.2.
    """
    out = np.empty((len(history), len(thresholds_Nm)))
    high = thresholds_Nm
    for rows, ways in zip(history.unit_slices, _ways_of(history, torque_Nm), strict=True):
        first = np.clip(start * high + torque_Nm[rows[0]], -high, high)
        states = _clipped_sums(first, ways.steps_Nm, high)
        # between two turns nothing is lost but at one limit
        moved = states[ways.number] + ways.since_Nm[:, None]
        out[rows] = np.clip(moved, -high, high, out=moved)
    return out


@dataclass(frozen=True)
class _Ways:
    """A unit's torque from turn to turn.

    Attributes
    ----------
    steps_Nm : (k,) from each turn to the next.
    number : (n,) of the way that each row is on.
    since_Nm : (n,) torque since the turn before.
    """

    steps_Nm: np.ndarray
    number: np.ndarray
    since_Nm: np.ndarray

    @classmethod
    def of(cls, torque_Nm: np.ndarray) -> _Ways:
        edges = [a for a, _ in _one_way(np.diff(torque_Nm, prepend=torque_Nm[0]))]
        ends = np.array([*edges, len(torque_Nm)])
        turns = np.r_[0, ends[1:] - 1]
        way = np.repeat(np.arange(len(edges)), np.diff(ends))
        at_turn = torque_Nm[turns]
        return cls(np.diff(at_turn), way, torque_Nm - at_turn[way])


def _ways_of(history: History, torque_Nm: np.ndarray) -> list[_Ways]:
    """Of each unit; those of the last torque stay, as many elements are driven by it one after the other."""
    key = ("ways", 0.0)
    if key not in history.memo or history.memo[key][0] is not torque_Nm:
        ways = [_Ways.of(torque_Nm[rows]) for rows in history.unit_slices]
        history.memo[key] = torque_Nm, ways
    ways_of_rows: list[_Ways] = history.memo[key][1]
    return ways_of_rows


def _clipped_sums(first: np.ndarray, steps: np.ndarray, limit: np.ndarray) -> np.ndarray:
    """(k + 1, m) x_j = clip(x_{j−1} + d_j, −r, r) from x_0 = `first` (m,), of steps d (k,).

    A sum clipped is min(max(x + a, low), high), and two of these one after the other are one such: of one,
    two, four … steps together they give every x_j in log₂ k rounds.
    """
    shift = steps[:, None].astype(float)
    low, high = np.tile(-limit, (len(steps), 1)), np.tile(limit, (len(steps), 1))
    span = 1
    while span < len(steps):
        after = shift[span:]
        lower = _clipped(low[:-span] + after, low[span:], high[span:])
        upper = _clipped(high[:-span] + after, low[span:], high[span:])
        low, high = np.vstack([low[:span], lower]), np.vstack([high[:span], upper])
        shift = np.vstack([shift[:span], shift[:-span] + after])
        span *= 2
    return np.vstack([first, _clipped(first + shift, low, high)])


def _clipped(values: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """numpy's `clip`, which takes four times as long for a few values."""
    return np.minimum(np.maximum(values, low), high)


def _one_way(steps: np.ndarray) -> list[tuple[int, int]]:
    """Stretches (first, after the last) along which no step turns back."""
    moving = np.flatnonzero(steps)
    turned = moving[1:][np.sign(steps[moving[1:]]) != np.sign(steps[moving[:-1]])]
    edges = [0, *turned.tolist(), len(steps)]
    return list(pairwise(edges))


@once
def play(history: History, width_Nm: float) -> np.ndarray:
    """(n,) torque that follows only beyond ± `width_Nm`: reversals smaller than twice that are gone.

    It goes to turns that nobody has written, too (`lost_turns.py`).
    """
    width = np.array([max(width_Nm, LEAST_TORQUE_Nm)])
    torque = turned_unseen(history)
    return np.asarray(torque - stops(history, torque, width, np.zeros(1))[:, 0])


@once
def steadied(history: History, width_Nm: float) -> np.ndarray:
    """(n,) torque without reversals smaller than twice `width_Nm`: its running extremes.

    Not smoothed: corners stay where they are. An operator with a memory, driven by the raw reading,
    would follow the reading's noise and be fitted to it.
    """
    return play(history, width_Nm) + width_Nm * rising(history, width_Nm)


def within_cycle(history: History) -> np.ndarray:
    """(n,) share of its cycle that lies before each row: of its time, or of its rows without time."""
    out = np.zeros(len(history))
    for rows in history.unit_slices:
        t = history.time_or_rows(rows)
        starts = np.flatnonzero(np.diff(history.cycle[rows], prepend=-1) != 0)
        ends = np.append(t[starts[1:]], t[-1] + (t[-1] - t[0]) / max(1, len(t) - 1))
        number = np.searchsorted(starts, np.arange(len(t)), side="right") - 1
        out[rows] = (t - t[starts[number]]) / np.maximum(
            ends[number] - t[starts[number]], ABOVE_ZERO
        )
    return out


def rising(history: History, width_Nm: float) -> np.ndarray:
    """(n,) 1 while torque rises, −1 while it falls, 0 before it first moves; noise does not count."""
    moved = play(history, width_Nm)
    out = np.zeros(len(moved))
    for rows in history.unit_slices:
        step = np.sign(np.diff(moved[rows], prepend=moved[rows[0]]))
        out[rows] = last_direction(step)
    return out


def last_direction(step: np.ndarray) -> np.ndarray:
    """(n,) the last of the steps that was not 0, so far; 0 before the first."""
    last = np.maximum.accumulate(np.where(step != 0, np.arange(len(step)), 0))
    return np.asarray(step[last])


def direction_of_loading(history: History) -> np.ndarray:
    """`rising`, by reversals larger than any noise that the torque may have."""
    return rising(history, LARGEST_NOISE * history.largest_Nm)


def dahl(
    history: History, stiffness_Nm: np.ndarray, exponent: np.ndarray, deadband_Nm: float
) -> np.ndarray:
    """(n, m) states z of elements of Dahl's, dz/dT = (1 − z·sign dT)^i/d, from z = 0.

    Exact for torque that is monotone between rows. Parameters: d (m,) [N·m], i (m,). Source: Dahl, A
    solid friction model, Aerospace Corporation TOR-158(3107-18) (1968).
    """
    moved = steadied(history, deadband_Nm)
    out = np.empty((len(moved), len(stiffness_Nm)))
    bend = exponent - 1
    straight = np.abs(bend) < 1e-3
    safe = np.where(straight, 1.0, bend)
    for rows in history.unit_slices:
        steps = np.diff(moved[rows], prepend=0.0)
        state, block = np.zeros(len(stiffness_Nm)), np.empty((len(rows), len(stiffness_Nm)))
        for first, last in _one_way(steps):
            side = np.sign(steps[first:last].sum())
            way = np.cumsum(np.abs(steps[first:last]))[:, None] / stiffness_Nm
            rest = np.maximum(1 - state * side, LEAST_TO_COME)
            # y = 1 − z·sign dT falls as dy/dx = −y^i: y^(1−i) grows by (i − 1)·x
            power = np.maximum(rest**-safe + safe * way, LEAST_TO_COME) ** (-1 / safe)
            block[first:last] = side * (1 - np.where(straight, rest * np.exp(-way), power))
            if side == 0:
                block[first:last] = state
            state = block[last - 1]
        out[rows] = block
    return out


def lags(values: np.ndarray, history: History, constants_s: np.ndarray) -> np.ndarray:
    """(n, m) first-order lags of `values` (n,), x' = (v − x)/τ, exact for v linear between rows.

    Each unit starts settled at its first value. Parameters: τ (m,) [s].

    Raises
    ------
    ValueError : the history has no time.
    """
    if history.time_s is None:
        raise ValueError("a lag needs time")
    out = np.empty((len(history), len(constants_s)))
    for rows in history.unit_slices:
        v, t = values[rows], history.time_s[rows]
        step = np.diff(t)[:, None] / constants_s
        keep = np.exp(-step)
        # v linear over the step: x₁ = x₀k + v₀(g − k) + v₁(1 − g), g = (1 − k)/step
        share = np.where(step > 1e-8, -np.expm1(-step) / np.maximum(step, ABOVE_ZERO), 1 - step / 2)
        drive = np.empty((len(v), len(constants_s)))
        drive[0] = v[0]
        drive[1:] = v[:-1, None] * (share - keep) + v[1:, None] * (1 - share)
        for m in range(len(constants_s)):
            out[rows, m] = first_order(keep[:, m], drive[:, m])
    return out
