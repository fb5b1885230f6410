"""The range of a model's record, and by how much another history exceeds it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.measurement.floors import LEAST_TORQUE_Nm
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.ramps import by_travel, moving_rates
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm

Ends = tuple[float, float]
MOST_TRAVEL = 0.95
"""Of the travel of torque was made at no more than the fastest rate that counts as measured, and at no less
than the slowest: the rest are starts and turns."""
RANGE_SLACK = 0.05
"""Share of a channel's range by which noise and rounding may exceed it. Judgement."""
RATE_SLACK = 0.5
"""Rates are taken over steps of eight times the torque's noise: three deviations of √2/8."""
LEAST_RANGE_K = 10.0
"""[K] Least range of temperature. Temperatures that differ by less count as one, and distances beyond are
measured in this. Judgement."""
LEAST_RATE_Nm_per_s = 1e-12
"""A rate of less is rounding of a hold: by it no rate is divided."""
QUARTER_DEG = 90.0
"""Of a turn of the wave generator: its strongest error, two a turn, goes from peak to zero in 45°."""


@dataclass(frozen=True)
class MeasuredSpan:
    """Ends of what was measured; None where the channel was not recorded.

    `rate_Nm_per_s` and `slowest_rate_Nm_per_s` are the fastest and the slowest at which torque moved for more
    than an instant, `smallest_loop_Nm` the largest torque of the smallest cycle.
    """

    torque_Nm: Ends
    smallest_loop_Nm: float | None = None
    rate_Nm_per_s: float | None = None
    temperature_C: Ends | None = None
    input_angle_deg: Ends | None = None
    slowest_rate_Nm_per_s: float | None = None


def span_of(history: History) -> MeasuredSpan:
    """The span of a record."""
    rates = [r for rows in history.unit_slices if (r := moving_rates(history, rows)) is not None]
    fastest, slowest = (
        [by_travel(r.values, r.travel_Nm, share) for r in rates]
        for share in (MOST_TRAVEL, 1 - MOST_TRAVEL)
    )
    return MeasuredSpan(
        _ends(history.torque_Nm),
        float(_loops_Nm(history).min()),
        max(fastest) if fastest and max(fastest) > 0 else None,
        None if history.temperature_C is None else _ends(history.temperature_C),
        None if history.input_angle_deg is None else _ends(history.input_angle_deg),
        min((rate for rate in slowest if rate > 0), default=None),
    )


def beyond(span: MeasuredSpan, history: History) -> dict[str, np.ndarray]:
    """(n,) how far each row lies outside, by channel, as a share of what was measured; 0 inside.

    Torque: of its largest value. Rate: doublings. Temperature: of its range, at least 10 K. Position: of a
    quarter turn, whole turns taken off.
    """
    low, high = span.torque_Nm
    largest = max(abs(low), abs(high), LEAST_TORQUE_Nm)
    room = RANGE_SLACK * largest + 3 * torque_noise_Nm(history)
    distance = {"torque_Nm": _outside(history.torque_Nm, (low, high), room) / largest}
    if span.rate_Nm_per_s is not None and history.time_s is not None:
        measured_Nm_per_s = span.rate_Nm_per_s * (1 + RATE_SLACK)
        distance["torque_rate"] = np.log2(np.maximum(_row_rates(history) / measured_Nm_per_s, 1.0))
    if span.temperature_C is not None and history.temperature_C is not None:
        wide = max(float(np.ptp(span.temperature_C)), LEAST_RANGE_K)
        out = _outside(history.temperature_C, span.temperature_C, RANGE_SLACK * wide)
        distance["temperature_C"] = out / wide
    if span.input_angle_deg is not None and history.input_angle_deg is not None:
        distance["input_angle_deg"] = _turned(history.input_angle_deg, span.input_angle_deg)
    return distance


def times_slower(span: MeasuredSpan, history: History) -> np.ndarray:
    """(n,) how many times as slow as the slowest measured each row's torque moves; 1 where not slower, or
    held."""
    if span.slowest_rate_Nm_per_s is None:
        return np.ones(len(history))
    rate = _row_rates(history)
    out = np.where(
        rate > 0, span.slowest_rate_Nm_per_s / np.maximum(rate, LEAST_RATE_Nm_per_s), 1.0
    )
    out[out < 1 + RATE_SLACK] = 1.0
    return out


def _loops_Nm(history: History) -> np.ndarray:
    """(n,) largest |torque| of each row's cycle."""
    out = np.empty(len(history))
    for rows in history.unit_slices:
        cycle, size = history.cycle[rows], np.abs(history.torque_Nm[rows])
        _, which = np.unique(cycle, return_inverse=True)
        largest = np.zeros(which.max() + 1)
        np.maximum.at(largest, which.ravel(), size)
        out[rows] = largest[which.ravel()]
    return out


def clipped(span: MeasuredSpan, history: History) -> History:
    """The history with torque and temperature held at the ends of what was measured."""
    temperature = history.temperature_C
    if temperature is not None and span.temperature_C is not None:
        temperature = np.clip(temperature, *span.temperature_C)
    return replace(
        history, torque_Nm=np.clip(history.torque_Nm, *span.torque_Nm), temperature_C=temperature
    )


def _ends(values: np.ndarray) -> Ends:
    return float(values.min()), float(values.max())


def _outside(values: np.ndarray, ends: Ends, room: float) -> np.ndarray:
    off = np.maximum(ends[0] - values, values - ends[1])
    return np.where(off > room, off, 0.0)


def _turned(angle_deg: np.ndarray, ends: Ends) -> np.ndarray:
    """Quarter turns to the nearer end of the arc that was measured."""
    arc = ends[1] - ends[0]
    if arc >= 360.0 - QUARTER_DEG / 2:  # the gap is closed from both sides
        return np.zeros(len(angle_deg))
    past = (angle_deg - ends[0]) % 360.0
    out = np.where(past <= arc, 0.0, np.minimum(past - arc, 360.0 - past))
    return np.where(out > RANGE_SLACK * QUARTER_DEG, out / QUARTER_DEG, 0.0)


def _row_rates(history: History) -> np.ndarray:
    """(n,) |torque rate| [N·m/s] of each row; 0 in holds, and in units without time."""
    out = np.zeros(len(history))
    for rows in history.unit_slices:
        if (rates := moving_rates(history, rows)) is None:
            continue
        own = np.where(rates.travel_Nm > 0, rates.values, 0.0)
        out[rows[: len(own)]] = own
        out[rows[len(own) :]] = own[-1]
    return out
