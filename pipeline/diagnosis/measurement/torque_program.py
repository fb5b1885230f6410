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
CLEAR = 8.0
"""Rates are taken over as many rows as make a ramp's step this many times the torque's noise."""
PARTS = 60
"""Of a cycle."""
FAST = 0.95
"""Quantile of rates, or of steps, of rows that move, that is a ramp's."""
NOISE_MOVES = 5.7
"""Times its noise that torque moves between two rows of a hold once in 18 000: 4σ of a difference."""
RANGE_SIGMAS = 6.0
"""Range of 450 rows of normal noise, in its standard deviations, on average; of more rows it is larger."""
SURE_SIGMAS = 3.0
"""Deviations of a hold's own rate by noise, by which it must be slower than what moves."""
AROUND = 20
"""Rows whose mean says where torque is before and after a gap between two runs: to a fifth of its noise."""
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
    """Torque rate [N·m/s] from each row of one unit to `width` rows later, (m,), and the travel in it.

    `travel_Nm` (m,) is how far torque moves there beyond what its noise does: 0 in a hold.
    """

    width: int
    values: np.ndarray
    travel_Nm: np.ndarray


def rates_of(history: History, rows: np.ndarray) -> Rates:
    """Rates along one unit's rows, over the fewest rows in which a ramp moves clear of the torque's noise."""
    assert history.time_s is not None
    torque, t = history.torque_Nm[rows], history.time_s[rows]
    noise = torque_noise_Nm(history)
    widest = max(1, len(rows) // 20)
    # a ramp's step, from moves over a small part of a cycle
    coarse = max(1, len(rows) // (PARTS * (int(history.cycle[rows].max()) + 1)))
    far = np.abs(torque[coarse:] - torque[:-coarse])
    far = far[far > NOISE_MOVES * noise]
    step = np.quantile(far, FAST) / coarse if len(far) else 0.0
    fewest = int(np.clip(np.ceil(CLEAR * noise / max(step, 1e-12)), 1, widest))
    width = 1  # a ramp may be shorter than that part
    while width < fewest:
        moved = np.abs(torque[width:] - torque[:-width])
        if by_travel(moved, np.maximum(moved - NOISE_MOVES * noise, 0.0), 0.5) >= CLEAR * noise:
            break
        width = min(2 * width, fewest)
    moved = torque[width:] - torque[:-width]
    travel = np.maximum(np.abs(moved) - NOISE_MOVES * noise, 0.0)
    span = np.maximum(t[width:] - t[:-width], 1e-12)
    return Rates(width, moved / span, travel)


def by_travel(values: np.ndarray, travel_Nm: np.ndarray, share: float) -> float:
    """The value below which `share` of the travel lies; 0 without any."""
    order = np.argsort(values)
    passed = np.cumsum(travel_Nm[order])
    if len(passed) == 0 or passed[-1] <= 0:
        return 0.0
    return float(values[order][np.searchsorted(passed, share * passed[-1])])


def ramp_rate(history: History) -> float:
    """Typical torque per second while it moves beyond its noise [N·m/s]; 0 without time."""
    key = ("ramp_rate", 0.0)
    if key not in history.memo:
        history.memo[key] = _ramp_rate(history)
    return float(history.memo[key])


def _ramp_rate(history: History) -> float:
    if history.time_s is None:
        return 0.0
    found = []
    for rows in history.unit_slices:
        if len(rows) < 2 * FEWEST or np.ptp(history.time_s[rows]) == 0:
            continue
        rates = rates_of(history, rows)
        rate = np.abs(rates.values[rates.travel_Nm > 0])  # most rows may lie in holds
        if len(rate):
            fast = np.quantile(rate, FAST)
            found.append(float(np.median(rate[rate > MOVING * fast])))
    return float(np.median(found)) if found else 0.0


def holds(history: History) -> list[np.ndarray]:
    """Rows of each stretch where torque stands still between two moves, at least `FEWEST` rows."""
    key = ("holds", 0.0)
    if key not in history.memo:
        history.memo[key] = _holds(history)
    found: list[np.ndarray] = history.memo[key]
    return found


def _holds(history: History) -> list[np.ndarray]:
    fast = ramp_rate(history)
    if fast == 0:
        return []
    noise = torque_noise_Nm(history)
    span = SPAN * float(np.abs(history.torque_Nm).max())
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
        runs = zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True)
        torque = history.torque_Nm[rows]
        for i, j in _joined([(int(i), int(j)) for i, j in runs], torque, t, width, noise, fast):
            before, after = rate[max(0, i - width - BESIDE) : i], rate[j : j + width + BESIDE]
            sharp = all(len(side) == 0 or side.max() > MOVING * fast for side in (before, after))
            hold = rows[i : j + width]
            spread = noise * max(RANGE_SIGMAS, _range_sigmas(len(hold)))
            level = np.ptp(history.torque_Nm[hold]) < span + spread
            if (
                len(hold) >= FEWEST
                and sharp
                and level
                and _stands(torque, t, i, j + width, noise, fast)
            ):
                found.append(hold)
    return found


def _joined(
    runs: list[tuple[int, int]],
    torque_Nm: np.ndarray,
    time_s: np.ndarray,
    width: int,
    noise_Nm: float,
    fast_Nm_per_s: float,
) -> list[tuple[int, int]]:
    """Runs of still rates (first, after the last), joined where only the torque's noise parts them.

    Noise alone passes any limit once in so many rows, and a hold may have thousands. What moves over
    both runs together is a slow ramp under noise, and stays apart.
    """

    def level(first: int, last: int) -> float:
        return float(torque_Nm[max(first, 0) : last + 1].mean())

    found: list[tuple[int, int]] = []
    for i, j in runs:
        if found and i - found[-1][1] <= width + BESIDE:
            a, b = found[-1]
            stepped = abs(level(max(a, b - AROUND), b) - level(i, min(j, i + AROUND)))
            share = min(AROUND, (j - a) // 2)  # rows at either end, not the same ones
            moved = abs(level(a, a + share) - level(j - share, j))
            passed = time_s[min(j, len(time_s) - 1)] - time_s[a]
            still = STILL * fast_Nm_per_s * passed + noise_Nm / 2
            if stepped < CLEAR / 2 * noise_Nm and moved < still:
                found[-1] = (a, j)
                continue
        found.append((i, j))
    return found


def _stands(
    torque_Nm: np.ndarray, time_s: np.ndarray, i: int, j: int, noise_Nm: float, fast: float
) -> bool:
    """Whether a straight line through rows i to j − 1 stands still, and surely not as torque moves beside.

    A few rows of a slow cycle, of a record with quick ones, may stand still by noise alone.
    """
    torque, away = torque_Nm[i:j], time_s[i:j] - time_s[i:j].mean()
    square = max(float((away**2).sum()), 1e-300)
    rate, doubt = abs(float(away @ torque)) / square, noise_Nm / square**0.5
    beside = min(fast, _rate_beside(torque_Nm, time_s, i, j))
    return rate - doubt < STILL * fast and rate + SURE_SIGMAS * doubt < MOVING * beside


def _rate_beside(torque_Nm: np.ndarray, time_s: np.ndarray, i: int, j: int) -> float:
    """Torque rate before rows i to j − 1 or after them, the slower, in as much time as they last.

    That of the ramp from their level on with the same rms; a side without rows counts for nothing.
    """
    level, lasts = float(torque_Nm[i:j].mean()), float(time_s[j - 1] - time_s[i])
    first = int(np.searchsorted(time_s, time_s[i] - lasts))
    end = int(np.searchsorted(time_s, time_s[j - 1] + lasts, side="right"))
    away = [
        float(np.mean((x - level) ** 2)) for x in (torque_Nm[first:i], torque_Nm[j:end]) if len(x)
    ]
    return (3 * min(away)) ** 0.5 / max(lasts, 1e-300) if away else np.inf


def _range_sigmas(count: int) -> float:
    """Range of so many rows of normal noise in its deviations, for many: 2√(2 ln n)."""
    return 2 * float(np.sqrt(2 * np.log(max(count, 2))))


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
    key = ("torque_noise", 0.0)
    if key not in history.memo:
        history.memo[key] = _torque_noise_Nm(history)
    return float(history.memo[key])


def _torque_noise_Nm(history: History) -> float:
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
