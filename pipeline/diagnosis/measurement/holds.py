"""Holds: rows at constant torque between two moves, under load or at rest."""

from __future__ import annotations

from math import hypot

import numpy as np

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.pipeline.diagnosis.measurement.floors import LEAST_TIME_S
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.measurement.ramps import (
    CLEAR_SIGMAS,
    FEWEST_HOLD_ROWS,
    MOVING,
    ramp_rate,
    rates_of,
)
from flexspline.pipeline.diagnosis.measurement.runs import runs
from flexspline.pipeline.diagnosis.measurement.torque_noise import DEADBAND_SIGMAS, torque_noise_Nm

HOLD_RATE_SHARE = 0.08
"""A hold's torque moves at less than this share of the ramps' rate,"""
BESIDE_ROWS = 5
"""Rows just before or after a hold, besides those over which a rate is computed. A programme's ramp reaches
its full rate within them, a sine near its peak does not."""
HOLD_RANGE_SHARE = 0.04
"""Over a whole hold, torque changes by less than this share of the largest torque. Judgement."""
RANGE_SIGMAS = 6.0
"""Range of 450 rows of normal noise, in its standard deviations, on average; of more rows it is larger."""
SURE_SIGMAS = 3.0
"""Standard deviations, by noise, by which a hold's rate must be lower than the rate beside it."""
CREST_ROWS = 2
"""Most rows of what may be a sine's crest, over the rows beside it, within which it must have a ramp's rate.
Judgement."""
PARABOLA_SHARE, PARABOLA_NOISE = 0.02, 1.4
"""What a parabola may leave of a sine's crest (rms), over its depth, and over the torque's noise: of a sine
without noise 0.012 at most, of a level between two ramps 0.034 to 0.09."""
AROUND_ROWS = 20
"""Rows of the mean torque before and after a gap between two runs. The mean is known to a fifth of the
noise."""

REST_SHARE = 0.05
"""Of the largest torque: below it a hold is a rest. Under load as small, twist hardly grows. Judgement."""


@once
def holds(history: History) -> list[np.ndarray]:
    """Rows of each stretch where torque stands still between two moves, at least `FEWEST_HOLD_ROWS` rows."""
    fast = ramp_rate(history)
    if fast == 0:
        return []
    span = HOLD_RANGE_SHARE * history.largest_Nm
    hold_rows = []
    for rows in history.unit_slices:
        if len(rows) < 2 * FEWEST_HOLD_ROWS:
            continue
        assert history.time_s is not None
        rates, noise = rates_of(history, rows), torque_noise_Nm(history, rows)
        width, rate = rates.width, np.abs(rates.values)
        t = history.time_s[rows]
        floor = 2 * DEADBAND_SIGMAS * noise / np.maximum(t[width:] - t[:-width], LEAST_TIME_S)
        limit = np.minimum(np.maximum(HOLD_RATE_SHARE * fast, floor), MOVING * fast)
        torque = history.torque_Nm[rows]
        # rows of a hold may lie far apart in time, and a ramp begin between two of them
        moved = np.abs(torque[width:] - torque[:-width])
        still = (rate < limit) & (moved < span + RANGE_SIGMAS * noise)
        for i, j in _joined(runs(still), torque, t, width, noise, fast):
            beside = width + BESIDE_ROWS
            before, after = rate[max(0, i - beside) : i], rate[j : j + beside]
            sharp = all(len(side) == 0 or side.max() > MOVING * fast for side in (before, after))
            hold = rows[i : j + width]
            spread = noise * max(RANGE_SIGMAS, _range_sigmas(len(hold)))
            level = np.ptp(history.torque_Nm[hold]) < span + spread
            if (
                len(hold) >= FEWEST_HOLD_ROWS
                and sharp
                and level
                and _stands(torque, t, i, j + width, noise, fast)
                and not (
                    len(hold) <= CREST_ROWS * beside and _is_crest(torque, t, i, j + width, noise)
                )
            ):
                hold_rows.append(hold)
    return hold_rows


def loaded_holds(history: History) -> list[np.ndarray]:
    """Those under load: at rest a lag's twist and creep's go back, over which neither grows."""
    least = REST_SHARE * history.largest_Nm
    return [rows for rows in holds(history) if abs(history.torque_Nm[rows].mean()) > least]


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

    joined: list[tuple[int, int]] = []
    for i, j in runs:
        if joined and i - joined[-1][1] <= width + BESIDE_ROWS:
            a, b = joined[-1]
            stepped = abs(level(max(a, b - AROUND_ROWS), b) - level(i, min(j, i + AROUND_ROWS)))
            share = min(AROUND_ROWS, (j - a) // 2)  # rows at either end, not the same ones
            moved = abs(level(a, a + share) - level(j - share, j))
            passed = time_s[min(j, len(time_s) - 1)] - time_s[a]
            still = HOLD_RATE_SHARE * fast_Nm_per_s * passed + noise_Nm / 2
            if stepped < CLEAR_SIGMAS / 2 * noise_Nm and moved < still:
                joined[-1] = (a, j)
                continue
        joined.append((i, j))
    return joined


def _stands(
    torque_Nm: np.ndarray, time_s: np.ndarray, i: int, j: int, noise_Nm: float, fast: float
) -> bool:
    """Whether a straight line through rows i to j − 1 stands still, and surely not as torque moves beside.

    A few rows of a slow cycle, of a record with quick ones, may stand still by noise alone.
    """
    torque, away = torque_Nm[i:j], time_s[i:j] - time_s[i:j].mean()
    square = max(float((away**2).sum()), ABOVE_ZERO)
    rate, doubt = abs(float(away @ torque)) / square, noise_Nm / square**0.5
    beside = min(fast, _rate_beside(torque_Nm, time_s, i, j))
    return rate - doubt < HOLD_RATE_SHARE * fast and rate + SURE_SIGMAS * doubt < MOVING * beside


def _is_crest(torque_Nm: np.ndarray, time_s: np.ndarray, i: int, j: int, noise_Nm: float) -> bool:
    """Whether torque turns in rows i to j − 1, and as many on either side, along a parabola.

    A sine's crest in a slow cycle of a record with quick ones, or of few rows, would else be a hold.
    """
    first, end = 2 * i - j, 2 * j - i
    if first < 0 or end > len(time_s):
        return False
    torque, t = torque_Nm[first:end], time_s[first:end] - time_s[i:j].mean()
    before, after = torque[[0, -1]] - torque_Nm[i:j].mean()
    depth = min(abs(before), abs(after))
    if before * after <= 0 or depth < CLEAR_SIGMAS / 2 * noise_Nm:
        return False
    left = torque - np.polynomial.Polynomial.fit(t, torque, 2)(t)
    most = hypot(PARABOLA_SHARE * depth, PARABOLA_NOISE * noise_Nm)
    return float(np.mean(left**2)) < most**2


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
    return (3 * min(away)) ** 0.5 / max(lasts, ABOVE_ZERO) if away else np.inf


def _range_sigmas(count: int) -> float:
    """Range of so many rows of normal noise in its deviations, for many: 2√(2 ln n)."""
    return 2 * float(np.sqrt(2 * np.log(max(count, 2))))


def hold_s(history: History) -> float:
    """Typical length of a hold, 0 without any: half of the time in holds is spent in no longer ones.

    If torque rings, it stands still for a few rows between two swings. Such holds are many but take little
    time.
    """
    if history.time_s is None:
        return 0.0
    lengths = np.sort([float(np.ptp(history.time_s[rows])) for rows in holds(history)])
    passed = np.cumsum(lengths)
    return float(lengths[np.searchsorted(passed, passed[-1] / 2)]) if len(lengths) else 0.0
