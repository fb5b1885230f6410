"""What the rig was told to do, read from the torque: holds and ramps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History

STILL = 0.08
"""A hold's torque moves at less than this share of the ramps' rate,"""
MOVING = 0.3
"""and just before and after it at more than this."""
BESIDE = 5
"""Rows that are just before or after."""
SPAN = 0.04
"""Over a whole hold torque changes by less than this share of the largest."""
FEWEST = 3
"""Rows of a hold: two are a turn between samples."""
PARTS = 60
"""Of a cycle."""
CLEAR = 8.0
"""Rates are taken over as many rows as make a ramp's step this many times the torque's noise."""
FAST = 0.95
"""Quantile of rates, or of steps, that is a ramp's: most rows may lie in holds."""
RANGE_SIGMAS = 6.0
"""Range of 450 rows of normal noise, in its standard deviations, on average."""
FEWEST_FOR_NOISE = 8
"""Rows of a unit; of fewer a median of third differences rests on less than five."""
DEADBAND_SIGMAS = 2.0
"""Half a reversal that may be noise: two rows of noise differ by more than twice this once in 210 times."""
MAD_PER_SIGMA, FIFTH_PER_SIGMA = 0.6745, 0.2533
"""Of |x| for x normal with deviation 1: its median Φ⁻¹(3/4), and what a fifth of it lies below, Φ⁻¹(3/5)."""
LARGEST_NOISE = 0.02
"""Of the largest torque: what looks like more is no noise."""


@dataclass(frozen=True)
class Rates:
    """Torque rate [N·m/s] from each row of one unit to `width` rows later, (m,)."""

    width: int
    values: np.ndarray


def rates_of(history: History, rows: np.ndarray) -> Rates:
    """Rates along one unit's rows, over a width that its torque noise allows."""
    assert history.time_s is not None
    torque, t = history.torque_Nm[rows], history.time_s[rows]
    noise = torque_noise_Nm(history)
    # a ramp's step, from moves over a small part of a cycle: most rows may lie in holds
    coarse = max(1, len(rows) // (PARTS * (int(history.cycle[rows].max()) + 1)))
    step = np.quantile(np.abs(torque[coarse:] - torque[:-coarse]), FAST) / coarse
    width = int(np.clip(np.ceil(CLEAR * noise / max(step, 1e-12)), 1, max(1, len(rows) // 20)))
    span = np.maximum(t[width:] - t[:-width], 1e-12)
    return Rates(width, (torque[width:] - torque[:-width]) / span)


def ramp_rate(history: History) -> float:
    """Typical torque per second while it moves [N·m/s]; 0 without time."""
    if history.time_s is None:
        return 0.0
    found = []
    for rows in history.unit_slices:
        if len(rows) < 2 * FEWEST or np.ptp(history.time_s[rows]) == 0:
            continue
        rate = np.abs(rates_of(history, rows).values)
        fast = np.quantile(rate, FAST)
        moving = rate[rate > MOVING * fast]
        if len(moving):
            found.append(float(np.median(moving)))
    return float(np.median(found)) if found else 0.0


def holds(history: History) -> list[np.ndarray]:
    """Rows of each stretch where torque stands still between two moves, at least `FEWEST` rows."""
    fast = ramp_rate(history)
    if fast == 0:
        return []
    noise = torque_noise_Nm(history)
    span = SPAN * float(np.abs(history.torque_Nm).max()) + RANGE_SIGMAS * noise
    found = []
    for rows in history.unit_slices:
        if len(rows) < 2 * FEWEST:
            continue
        assert history.time_s is not None
        rates = rates_of(history, rows)
        width, rate = rates.width, np.abs(rates.values)
        t = history.time_s[rows]
        floor = 2 * DEADBAND_SIGMAS * noise / np.maximum(t[width:] - t[:-width], 1e-12)
        limit = np.minimum(np.maximum(STILL * fast, floor), MOVING * fast)
        edges = np.diff(np.r_[0, (rate < limit).astype(int), 0])
        for i, j in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
            before, after = rate[max(0, i - width - BESIDE) : i], rate[j : j + width + BESIDE]
            sharp = all(len(side) == 0 or side.max() > MOVING * fast for side in (before, after))
            hold = rows[i : j + width]
            if len(hold) >= FEWEST and sharp and np.ptp(history.torque_Nm[hold]) < span:
                found.append(hold)
    return found


def hold_s(history: History) -> float:
    """Typical (median) length of a hold, 0 without any."""
    if history.time_s is None:
        return 0.0
    lengths = [float(np.ptp(history.time_s[rows])) for rows in holds(history)]
    return float(np.median(lengths)) if lengths else 0.0


def ramp_s(history: History) -> float:
    """Time of a ramp from zero to the largest torque, 0 without time or movement."""
    rate = ramp_rate(history)
    return float(np.abs(history.torque_Nm).max()) / rate if rate > 0 else 0.0


def deadband_Nm(history: History) -> float:
    """Half the reversal of torque that may be noise: what has a memory is driven without such."""
    return DEADBAND_SIGMAS * torque_noise_Nm(history)


def shortest_lag_s(history: History) -> float:
    """Lag over which a ramp moves clear of the torque's noise; 0 without time or movement.

    Over a shorter time the noise is a good part of the torque's change.
    """
    rate = ramp_rate(history)
    return CLEAR * torque_noise_Nm(history) / rate if rate > 0 else 0.0


def torque_noise_Nm(history: History) -> float:
    """White noise of the torque reading [N·m].

    The least of three estimates, each too large where its assumption fails: from rows off the straight
    line in time between their neighbours (ramps), from third differences (curved programmes, evenly
    sampled), and from the smallest fifth of the steps between rows (holds).
    """
    found = []
    for rows in history.unit_slices:
        torque = history.torque_Nm[rows]
        if len(torque) < FEWEST_FOR_NOISE:
            continue
        t = np.arange(len(rows), dtype=float) if history.time_s is None else history.time_s[rows]
        span = np.maximum(t[2:] - t[:-2], 1e-12)
        share = np.clip((t[1:-1] - t[:-2]) / span, 0.0, 1.0)
        off = torque[1:-1] - (1 - share) * torque[:-2] - share * torque[2:]
        line = np.median(np.abs(off) / np.sqrt(1 + share**2 + (1 - share) ** 2)) / MAD_PER_SIGMA
        third = (
            np.median(np.abs(np.diff(torque, 3))) / MAD_PER_SIGMA / np.sqrt(20)
        )  # 1² + 3² + 3² + 1²
        first = np.quantile(np.abs(np.diff(torque)), 0.2) / FIFTH_PER_SIGMA / np.sqrt(2)
        found.append(min(line, third, first))
    largest = float(np.abs(history.torque_Nm).max())
    return min(float(np.median(found)), LARGEST_NOISE * largest) if found else 0.0
