"""Rates of torque, of single rows and of ramps, and durations that follow from them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.measurement.floors import LEAST_TIME_S, LEAST_TORQUE_Nm
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.lost_rows import far_apart
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm

MOVING = 0.3
"""Share of the fast rate. Slower rows lie in a hold or a turn, not on a ramp. Judgement."""
FEWEST_HOLD_ROWS = 3
"""Fewest rows of a hold. Two rows may be a turn between samples."""
CLEAR_SIGMAS = 8.0
"""Rates are taken over as many rows as make a ramp's step this many times the torque's noise."""
SHORT_SPAN = 0.3
"""Of the usual time over which a rate is taken, below which none is: rows at random times lie close together,
and the noise of their torques passes for a rate."""
CYCLE_PARTS = 60
"""Parts of a cycle. Steps over one part give the first estimate of a ramp's rate. Judgement."""
FEWEST_STEPS = 20
"""Fewest parts of a unit's rows, side by side, that the widest step of a rate must leave."""
FAST_QUANTILE = 0.95
"""Quantile of the rates, or steps, of moving rows that is taken for a ramp's."""
NOISE_OF_FAST = 2.33
"""Times its noise, by which the difference of two rows exceeds the torque's at that quantile: 1.645·√2."""
NOISE_MOVES = 5.7
"""Times its noise that torque moves between two rows of a hold once in 18 000: 4σ of a difference."""


@dataclass(frozen=True)
class Rates:
    """Torque rate [N·m/s] from each row of one unit to `width` rows later, (m,), and the travel in it.

    `travel_Nm` (m,) is how far torque moves there beyond what its noise does: 0 in a hold.
    """

    width: int
    values: np.ndarray
    travel_Nm: np.ndarray


def rates_of(history: History, rows: np.ndarray) -> Rates:
    """Rates along a unit's or a cycle's rows, over the fewest rows in which a ramp exceeds the torque's
    noise."""
    assert history.time_s is not None
    torque, t = history.torque_Nm[rows], history.time_s[rows]
    noise = torque_noise_Nm(history, rows)
    widest = max(1, len(rows) // FEWEST_STEPS)
    cycles = int(np.ptp(history.cycle[rows])) + 1
    coarse = max(1, len(rows) // (CYCLE_PARTS * cycles))
    part = np.searchsorted(far_apart(t, torque, coarse), np.arange(len(rows)))

    def beyond(moved: np.ndarray) -> np.ndarray:
        return np.maximum(moved - NOISE_MOVES * noise, 0.0)

    def moved(width: int) -> np.ndarray:
        """(m,) without sign; 0 over a loss of rows, which says little of a rate."""
        return np.abs(torque[width:] - torque[:-width]) * (part[width:] == part[:-width])

    far = moved(coarse)
    far = far[far > NOISE_MOVES * noise]
    fast = np.quantile(far, FAST_QUANTILE) - NOISE_OF_FAST * noise if len(far) else 0.0
    step = fast / coarse
    fewest = int(np.clip(np.ceil(CLEAR_SIGMAS * noise / max(step, LEAST_TORQUE_Nm)), 1, widest))
    width = 1  # a ramp may be shorter than that part
    while width < fewest:
        steps = moved(width)
        if by_travel(steps, beyond(steps), 0.5) >= CLEAR_SIGMAS * noise:
            break
        width = min(2 * width, fewest)
    span = np.maximum(t[width:] - t[:-width], LEAST_TIME_S)
    travel = beyond(moved(width))
    # a hold may be logged far slower than a ramp, and have most of the rows
    usual = min(by_travel(span, travel, 0.5) or np.inf, float(np.median(span)))
    long_enough = span > SHORT_SPAN * usual
    return Rates(width, (torque[width:] - torque[:-width]) / span, travel * long_enough)


def moving_rates(history: History, rows: np.ndarray) -> Rates | None:
    """`rates_of`, their values without sign; None without time, or where too few rows say."""
    if (
        history.time_s is None
        or len(rows) < 2 * FEWEST_HOLD_ROWS
        or np.ptp(history.time_s[rows]) == 0
    ):
        return None
    rates = rates_of(history, rows)
    return replace(rates, values=np.abs(rates.values))


def by_travel(values: np.ndarray, travel_Nm: np.ndarray, share: float) -> float:
    """The value below which `share` of the travel lies; 0 without any."""
    order = np.argsort(values)
    passed = np.cumsum(travel_Nm[order])
    if len(passed) == 0 or passed[-1] <= 0:
        return 0.0
    return float(values[order][np.searchsorted(passed, share * passed[-1])])


def cycle_rate(history: History, rows: np.ndarray) -> float:
    """Torque rate [N·m/s] that half of a cycle's travel is slower than; 0 where too few rows say."""
    if len(rows) < 2 * FEWEST_HOLD_ROWS:
        return 0.0
    rates = rates_of(history, rows)
    return by_travel(np.abs(rates.values), rates.travel_Nm, 0.5)


@once
def ramp_rate(history: History) -> float:
    """Typical torque per second while it moves beyond its noise [N·m/s]; 0 without time."""
    ramps = []
    for rows in history.unit_slices:
        if (rates := moving_rates(history, rows)) is None:
            continue
        rate = rates.values[rates.travel_Nm > 0]  # most rows may lie in holds
        if len(rate):
            fast = np.quantile(rate, FAST_QUANTILE)
            ramps.append(float(np.median(rate[rate > MOVING * fast])))
    return float(np.median(ramps)) if ramps else 0.0


def ramp_s(history: History) -> float:
    """Time of a ramp from zero to the largest torque, 0 without time or movement."""
    rate = ramp_rate(history)
    return history.largest_Nm / rate if rate > 0 else 0.0


def slowest_ramp_s(history: History) -> float:
    """Time of a ramp from zero to the largest torque at the slowest cycle's rate; 0 where no cycle says."""
    rates = [cycle_rate(history, rows) for rows in history.cycle_slices]
    slowest = min((r for r in rates if r > 0), default=0.0)
    return history.largest_Nm / slowest if slowest > 0 else 0.0


def shortest_lag_s(history: History) -> float:
    """Lag over which a ramp moves clear of the torque's noise; 0 without time or movement.

    Over a shorter time the noise is a good part of the torque's change.
    """
    rate = ramp_rate(history)
    return CLEAR_SIGMAS * torque_noise_Nm(history) / rate if rate > 0 else 0.0
