"""Operators on a history that several causes need: friction elements and lags."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.linalg.lapack import dtbtrs

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_program import LARGEST_NOISE


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
    high, low = thresholds_Nm, -thresholds_Nm
    for rows in history.unit_slices:
        state = np.clip(start * high + torque_Nm[rows[0]], low, high)
        steps = np.diff(torque_Nm[rows], prepend=torque_Nm[rows[0]])
        block = np.empty((len(rows), len(high)))
        for first, last in _one_way(steps):  # along it nothing is lost but at one limit
            moved = state + np.cumsum(steps[first:last])[:, None]
            one = np.minimum(moved, high) if steps[first:last].sum() > 0 else np.maximum(moved, low)
            block[first:last], state = one, one[-1]
        out[rows] = block
    return out


def _one_way(steps: np.ndarray) -> list[tuple[int, int]]:
    """Stretches (first, after the last) along which no step turns back."""
    moving = np.flatnonzero(steps)
    turned = moving[1:][np.sign(steps[moving[1:]]) != np.sign(steps[moving[:-1]])]
    edges = [0, *turned.tolist(), len(steps)]
    return list(pairwise(edges))


def play(history: History, width_Nm: float) -> np.ndarray:
    """(n,) torque that follows only beyond ± `width_Nm`: reversals smaller than twice that are gone."""
    width = np.array([max(width_Nm, 1e-12)])
    key = ("play", float(width[0]))
    if key not in history.memo:
        state = stops(history, history.torque_Nm, width, np.zeros(1))[:, 0]
        history.memo[key] = history.torque_Nm - state
    return history.memo[key]


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
        t = np.arange(len(rows), dtype=float) if history.time_s is None else history.time_s[rows]
        starts = np.flatnonzero(np.diff(history.cycle[rows], prepend=-1) != 0)
        ends = np.append(t[starts[1:]], t[-1] + (t[-1] - t[0]) / max(1, len(t) - 1))
        number = np.searchsorted(starts, np.arange(len(t)), side="right") - 1
        out[rows] = (t - t[starts[number]]) / np.maximum(ends[number] - t[starts[number]], 1e-12)
    return out


def rising(history: History, width_Nm: float) -> np.ndarray:
    """(n,) 1 while torque rises, −1 while it falls, 0 before it first moves; noise does not count."""
    moved = play(history, width_Nm)
    out = np.zeros(len(moved))
    for rows in history.unit_slices:
        step = np.sign(np.diff(moved[rows], prepend=moved[rows[0]]))
        last = np.maximum.accumulate(np.where(step != 0, np.arange(len(step)), 0))
        out[rows] = step[last]
    return out


def direction_of_loading(history: History) -> np.ndarray:
    """`rising`, by reversals larger than any noise that the torque may have."""
    return rising(history, LARGEST_NOISE * float(np.abs(history.torque_Nm).max()))


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
        way = np.abs(steps)[:, None] / stiffness_Nm
        keep = np.exp(-way)
        side = np.sign(steps)
        state, block = np.zeros(len(stiffness_Nm)), np.empty((len(rows), len(stiffness_Nm)))
        for i in range(len(rows)):
            if side[i] != 0:
                rest = np.maximum(1 - state * side[i], 1e-12)
                # y = 1 − z·sign dT falls as dy/dx = −y^i: y^(1−i) grows by (i − 1)·x
                power = np.maximum(rest**-safe + safe * way[i], 1e-12) ** (-1 / safe)
                state = side[i] * (1 - np.where(straight, rest * keep[i], power))
            block[i] = state
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
        share = np.where(step > 1e-8, -np.expm1(-step) / np.maximum(step, 1e-300), 1 - step / 2)
        drive = v[:-1, None] * (share - keep) + v[1:, None] * (1 - share)
        # x_i − k_i x_{i−1} = drive_i: a lower bidiagonal system for each constant
        band = np.ones((2, len(rows)), order="F")
        for m in range(len(constants_s)):
            band[1, :-1] = -keep[:, m]
            right = np.r_[v[0], drive[:, m]]
            out[rows, m] = dtbtrs(band, right[:, None], uplo="L", diag="U", overwrite_b=1)[0][:, 0]
    return out
