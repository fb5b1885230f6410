"""What the rig was told to do, read from the torque: holds and ramps."""

from __future__ import annotations

import numpy as np

from pipeline.diagnosis.record import History

STILL = 0.08
"""A hold's torque moves at less than this share of the ramps' rate,"""
MOVING = 0.3
"""and just before and after it at more than this."""
SPAN = 0.04
"""Over a whole hold torque changes by less than this share of the largest."""
FEWEST = 5
WINDOW = 3


def local_rates(history: History, rows: np.ndarray) -> np.ndarray:
    """(m,) slope of torque over time [N·m/s] at one unit's rows, over three rows on each side."""
    assert history.time_s is not None
    torque, t = history.torque_Nm[rows], history.time_s[rows]
    n = len(rows)
    low, high = np.maximum(np.arange(n) - WINDOW, 0), np.minimum(np.arange(n) + WINDOW, n - 1)
    half = (high - low) // 2
    # difference of the means of the later and the earlier rows: as good as a fit, and simple
    total = np.concatenate([[0.0], np.cumsum(torque)])
    clock = np.concatenate([[0.0], np.cumsum(t)])
    count = np.maximum(half, 1)
    later = (total[high + 1] - total[high + 1 - count]) / count
    early = (total[low + count] - total[low]) / count
    step = (clock[high + 1] - clock[high + 1 - count]) / count - (clock[low + count] - clock[low]) / count
    return (later - early) / np.maximum(step, 1e-12)


def ramp_rate(history: History) -> float:
    """Typical torque per second while it moves [N·m/s]; 0 without time."""
    if history.time_s is None:
        return 0.0
    found = []
    for rows in history.unit_slices:
        if len(rows) < 2 * WINDOW or np.ptp(history.time_s[rows]) == 0:
            continue
        rate = np.abs(local_rates(history, rows))
        fast = np.quantile(rate, 0.95)
        moving = rate[rate > MOVING * fast]
        if len(moving):
            found.append(float(np.median(moving)))
    return float(np.median(found)) if found else 0.0


def holds(history: History) -> list[np.ndarray]:
    """Rows of each stretch where torque stands still between two moves, at least `FEWEST` rows."""
    fast = ramp_rate(history)
    if fast == 0:
        return []
    largest = float(np.abs(history.torque_Nm).max())
    noise = torque_noise_Nm(history)
    span = SPAN * largest + 6 * noise
    found = []
    for rows in history.unit_slices:
        if len(rows) < 2 * WINDOW:
            continue
        assert history.time_s is not None
        gap = np.median(np.diff(history.time_s[rows]))
        still = max(STILL * fast, 3 * noise / (np.sqrt(WINDOW) * WINDOW * max(gap, 1e-12)))
        rate = np.abs(local_rates(history, rows))
        edges = np.diff(np.r_[0, (rate < min(still, MOVING * fast)).astype(int), 0])
        for i, j in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
            before, after = rate[max(0, i - FEWEST) : i], rate[j : j + FEWEST]
            sharp = all(len(side) == 0 or side.max() > MOVING * fast for side in (before, after))
            if j - i >= FEWEST and sharp and np.ptp(history.torque_Nm[rows[i:j]]) < span:
                found.append(rows[i:j])
    return found


def longest_hold_s(history: History) -> float:
    """Length of the longest hold, 0 without any."""
    if history.time_s is None:
        return 0.0
    return max((float(np.ptp(history.time_s[rows])) for rows in holds(history)), default=0.0)


def ramp_s(history: History) -> float:
    """Time of a ramp from zero to the largest torque, 0 without time or movement."""
    rate = ramp_rate(history)
    return float(np.abs(history.torque_Nm).max()) / rate if rate > 0 else 0.0


def torque_noise_Nm(history: History) -> float:
    """White noise of the torque reading: median of third differences, which ramps do not enter."""
    found = []
    for rows in history.unit_slices:
        torque = history.torque_Nm[rows]
        if len(torque) >= 8:
            third = np.abs(np.diff(torque, 3))
            found.append(np.median(third) / 0.6745 / np.sqrt(20))
    return float(np.median(found)) if found else 0.0
