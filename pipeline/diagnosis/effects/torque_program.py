"""What the rig was told to do, read from the torque: holds and ramps."""

from __future__ import annotations

import numpy as np

from pipeline.diagnosis.record import History

STILL = 0.04
"""A hold's torque stays within this share of the largest torque."""
FEWEST = 6


def holds(history: History) -> list[np.ndarray]:
    """Rows of each stretch where torque stands still for at least `FEWEST` rows.

    Ramps are told from holds by the rate: a hold moves less than `STILL` of the largest torque over a
    time in which a ramp would move ten times that.
    """
    if history.time_s is None:
        return []
    band = STILL * np.abs(history.torque_Nm).max()
    found = []
    for rows in history.unit_slices:
        torque, t = history.torque_Nm[rows], history.time_s[rows]
        shortest = 10 * band / max(typical_rate(torque, t), 1e-300)
        i = 0
        while i < len(rows):
            low = high = torque[i]
            j = i
            while j + 1 < len(rows):
                low, high = min(low, torque[j + 1]), max(high, torque[j + 1])
                if high - low > band:
                    break
                j += 1
            if j - i + 1 >= FEWEST and t[j] - t[i] > shortest:
                found.append(rows[i : j + 1])
                i = j + 1
            else:
                i += 1
    return found


def typical_rate(torque_Nm: np.ndarray, time_s: np.ndarray) -> float:
    """Torque per second while it moves: path of a torque thinned to steps of a tenth of its range."""
    step = 0.1 * np.ptp(torque_Nm)
    if step == 0 or np.ptp(time_s) == 0:
        return 0.0
    rates, last = [], 0
    for i in range(1, len(torque_Nm)):
        moved = abs(torque_Nm[i] - torque_Nm[last])
        if moved >= step:
            rates.append(moved / max(time_s[i] - time_s[last], 1e-12))
            last = i
    return float(np.quantile(rates, 0.75)) if rates else 0.0


def longest_hold_s(history: History) -> float:
    """Length of the longest hold, 0 without any."""
    if history.time_s is None:
        return 0.0
    return max((float(np.ptp(history.time_s[rows])) for rows in holds(history)), default=0.0)


def ramp_s(history: History) -> float:
    """Time of a ramp from zero to the largest torque."""
    if history.time_s is None:
        return 0.0
    largest = np.abs(history.torque_Nm).max()
    found = [
        largest / rate
        for rows in history.unit_slices
        if (rate := typical_rate(history.torque_Nm[rows], history.time_s[rows])) > 0
    ]
    return min(found, default=0.0)


def torque_noise_Nm(history: History) -> float:
    """White noise of the torque reading: median of third differences, which ramps do not enter."""
    found = []
    for rows in history.unit_slices:
        torque = history.torque_Nm[rows]
        if len(torque) >= 8:
            third = np.abs(np.diff(torque, 3))
            found.append(np.median(third) / 0.6745 / np.sqrt(20))
    return float(np.median(found)) if found else 0.0
