"""Competitors without a name: flexible functions of each channel.

They stand in the race beside the named causes, so that an effect that no cause explains is not given
the name of the cause that mimics it best.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Rig
from flexspline.pipeline.diagnosis.causes.operators import lags, rising, steadied, stops
from flexspline.pipeline.diagnosis.measurement.torque_program import (
    deadband_Nm,
    ramp_s,
    shortest_lag_s,
)
from flexspline.pipeline.diagnosis.prediction import REFERENCE_C

NEW_SHARE = 0.25
"""Of a column's own size: one of which less is new beside torque and gap is no nuisance term."""
SPLINE = 6
"""Degree of a smooth function over a channel, Legendre polynomials."""
LEADS = "output leads torque"
OPPOSITE = {
    "_leading": frozenset({"friction_hysteresis", "rate_dependence"}),
    "_softening": frozenset({"stiffness_hardening"}),
}
"""What a nuisance term is the reverse of: beside it the two would cancel."""
LEADING_THRESHOLDS = (0.08, 0.2, 0.4, 0.8)
"""Shares of the largest torque, within those of `friction_hysteresis`, which they reverse."""
LEADING_LAGS = (0.05, 0.15, 0.4)
"""Time constants as shares of a ramp, within those of `rate_dependence`, which they reverse."""
SOFTENING = (1.3, 1.6, 2.0, 2.5, 3.0, 4.0)
"""Powers of torque, all above 1: twist grows faster than torque."""
STEPS = 25
"""Places of a step in time, evenly over a unit's rows."""
TELLING = 7
"""Positions up to here can be anything and yet be the harmonics 1, 2 and 4."""
MOST_LEVELS = 8
"""Columns of one nuisance term at most."""
RIPPLES = range(3, 33)
"""Half periods over the range of torque or angle."""
WAVES = range(3, 61)
"""Half periods over the time of the record."""


@dataclass(frozen=True)
class NuisanceTerm:
    """A flexible term: which channel it lives in, what it is, and its columns (n, k)."""

    channel: str
    what: str
    columns: np.ndarray
    positive: bool = False
    against: frozenset[str] = frozenset()
    """Causes beside which it does not stand: it is their opposite, and the two would cancel."""


def nuisance_terms(rig: Rig) -> list[NuisanceTerm]:
    """All flexible terms that a rig's record has the channels for.

    Columns have unit rms. Ripples, waves and curves come less what zero, compliance and gap can be.
    """
    h = rig.history
    # a wave in time with the torque's own period is the torque without its noise, and would win by that
    # and a wave in quadrature with it, beside a lag, is that too
    free = np.column_stack([np.ones(len(h)), h.torque_Nm, h.sign, _lagging(rig)])
    inverse = np.linalg.pinv(free)
    found = []
    for make in MAKERS:
        for channel, what, columns in make(rig):
            rest = columns
            if make in (_torque, _angle, _time, _direction) and what != CHANGING:
                rest = columns - free @ (inverse @ columns)
            was = np.sqrt(((columns - columns.mean(axis=0)) ** 2).mean(axis=0))
            rms = np.sqrt((rest**2).mean(axis=0))
            good = rms > NEW_SHARE * np.maximum(was, 1e-9)
            if good.any():
                positive = make in (_leading, _softening)
                against = OPPOSITE.get(make.__name__, frozenset[str]())
                found.append(
                    NuisanceTerm(channel, what, rest[:, good] / rms[good], positive, against)
                )
    return found


Made = Iterator[tuple[str, str, np.ndarray]]


def _lagging(rig: Rig) -> np.ndarray:
    """(n, 2) torque through a short and a long lag; no columns without time or movement."""
    ramp = ramp_s(rig.history)
    if ramp <= 0:
        return np.empty((len(rig.history), 0))
    return lags(rig.history.torque_Nm, rig.history, np.array([0.1, 0.4]) * ramp)


def _steady(rig: Rig) -> np.ndarray:
    """(n,) torque relative to the largest, without its noise: a ripple of the raw reading would fit that."""
    return steadied(rig.history, deadband_Nm(rig.history)) / rig.torque_Nm


def _torque(rig: Rig) -> Made:
    torque = _steady(rig)
    yield "torque_Nm", "a smooth function of torque", _splines(torque, SPLINE)
    yield "torque_Nm", "a curve of torque, equal for both signs", (torque**2)[:, None]
    yield from _ripples(torque, "torque_Nm", "a ripple over torque")


def _softening(rig: Rig) -> Made:
    """Stiffness that falls with load: no known cause, and anchored where the load is small."""
    torque = _steady(rig)
    for power in SOFTENING:
        soft = np.abs(torque) ** power * rig.history.sign
        yield "torque_Nm", "stiffness that falls with load", soft[:, None]


def _angle(rig: Rig) -> Made:
    steady = replace(rig.history, torque_Nm=_steady(rig) * rig.torque_Nm)
    angle = rig.prediction.angle_arcsec(steady)
    yield from _ripples(
        angle / np.abs(angle).max(), "angle_arcsec", "a ripple over the output angle"
    )


def _ripples(x: np.ndarray, channel: str, what: str) -> Made:
    for k in RIPPLES:
        turn = np.pi * k * (x + 1) / 2
        yield channel, what, np.column_stack([np.cos(turn), np.sin(turn)])


def _direction(rig: Rig) -> Made:
    """A loop wider on one side of zero than on the other: friction elements make none such."""
    torque = rig.history.torque_Nm / rig.torque_Nm
    direction = rising(rig.history, 0.02 * rig.torque_Nm)
    basis = np.column_stack([direction * torque, direction * torque**3])
    yield "direction", "a loop that differs between the two sides", basis


def _leading(rig: Rig) -> Made:
    """Loops run through the wrong way round: friction and lag with their sign reversed."""
    yield "direction", LEADS, rising(rig.history, 0.02 * rig.torque_Nm)[:, None]
    thresholds = np.array(LEADING_THRESHOLDS) * rig.torque_Nm
    torque = steadied(rig.history, deadband_Nm(rig.history))
    states = stops(rig.history, torque, thresholds, np.zeros(len(thresholds))).T
    for r, state in zip(thresholds, states, strict=True):
        yield "direction", LEADS, (state / r)[:, None]
        yield "direction", LEADS, (state / r - rig.history.torque_Nm / rig.torque_Nm)[:, None]
    ramp = ramp_s(rig.history)
    for share in LEADING_LAGS if ramp > 0 else ():
        lagging = lags(
            torque, rig.history, np.array([max(share * ramp, shortest_lag_s(rig.history))])
        )[:, 0]
        yield "direction", LEADS, (torque - lagging)[:, None]


CHANGING = "a stiffness that changes with time"


def _time(rig: Rig) -> Made:
    if rig.duration_s <= 0 or rig.history.time_s is None:
        return
    t = np.zeros(len(rig.history))
    for rows in rig.history.unit_slices:
        t[rows] = (rig.history.time_s[rows] - rig.history.time_s[rows[0]]) / rig.duration_s
    torque = rig.history.torque_Nm / rig.torque_Nm
    yield "time_s", "a smooth function of time", _splines(2 * t - 1, SPLINE)
    for count in (1, 2, 3):
        yield (
            "time_s",
            CHANGING,
            torque[:, None] * np.column_stack([t**k for k in range(1, count + 1)]),
        )
    for k in WAVES:
        turn = np.pi * k * t
        yield "time_s", "a wave in time", np.column_stack([np.cos(turn), np.sin(turn)])
    for u, rows in enumerate(rig.history.unit_slices):
        for place in np.linspace(0, 1, STEPS + 2)[1:-1]:
            step = np.zeros(len(t))
            step[rows[int(place * len(rows)) :]] = 1.0
            where = f" of unit {u + 1}" if len(rig.history.unit_slices) > 1 else ""
            yield "time_s", f"a step in time{where}", step[:, None]


def _cycle(rig: Rig) -> Made:
    if rig.cycles < 2:
        return
    levels = _levels(rig.history.cycle.astype(float))
    torque = rig.history.torque_Nm / rig.torque_Nm
    yield "cycle", "a zero of its own in each cycle", levels
    yield "cycle", "a stiffness of its own in each cycle", levels * torque[:, None]
    ramp = rig.history.cycle / (rig.cycles - 1)
    for power in (1.0, 0.5):
        yield (
            "cycle",
            "a stiffness that changes from cycle to cycle",
            (ramp**power * torque)[:, None],
        )
    yield "cycle", "a gap of its own in each cycle", levels * rig.history.sign[:, None]


def _temperature(rig: Rig) -> Made:
    temperature = rig.history.temperature_C
    if temperature is None or np.ptp(temperature) < 0.3:
        return
    torque = rig.history.torque_Nm / rig.torque_Nm
    warm = (temperature - REFERENCE_C) / max(np.abs(temperature - REFERENCE_C).max(), 1e-9)
    centred = 2 * (temperature - temperature.min()) / np.ptp(temperature) - 1
    yield "temperature_C", "a zero that changes with temperature", warm[:, None]
    yield "temperature_C", "a zero that changes with temperature", _splines(centred, 3)
    yield "temperature_C", "a stiffness that changes with temperature", (warm * torque)[:, None]
    yield "temperature_C", "a gap not linear in temperature", (warm**2 * rig.history.sign)[:, None]


def _position(rig: Rig) -> Made:
    angle = rig.history.input_angle_deg
    if angle is None or np.ptp(angle) == 0:
        return
    torque = rig.history.torque_Nm / rig.torque_Nm
    levels = _levels(np.mod(angle, 360.0))
    if len(np.unique(np.mod(angle, 360.0))) > TELLING:
        yield "input_angle_deg", "a zero of its own at each position", levels
        yield "input_angle_deg", "a stiffness of its own at each position", levels * torque[:, None]
    yield "input_angle_deg", "a gap of its own at each position", levels * rig.history.sign[:, None]


def _unit(rig: Rig) -> Made:
    units = rig.history.unit_slices
    if len(units) < 2:
        return
    torque = rig.history.torque_Nm / rig.torque_Nm
    for u, rows in enumerate(units):
        own = np.zeros(len(torque))
        own[rows] = 1.0
        yield "unit", f"a gain of unit {u + 1}'s own", (own * torque)[:, None]
        yield "unit", f"a gap of unit {u + 1}'s own", (own * rig.history.sign)[:, None]


def _levels(values: np.ndarray) -> np.ndarray:
    """(n, k) one column per level but the first; neighbouring levels share one where they are many."""
    seen = np.unique(values)
    if len(seen) > MOST_LEVELS + 1:
        seen = np.quantile(values, np.linspace(0, 1, MOST_LEVELS + 2)[:-1])
        index = np.clip(np.searchsorted(seen, values, side="right") - 1, 0, None)
    else:
        index = np.searchsorted(seen, values)
    return np.column_stack([index == i for i in range(1, max(2, index.max() + 1))]).astype(float)


def _splines(x: np.ndarray, count: int) -> np.ndarray:
    """(n, count) Legendre polynomials of degree 1 to `count` over −1…1."""
    return np.polynomial.legendre.legvander(np.clip(x, -1, 1), count)[:, 1:]


MAKERS = (
    _torque, _softening, _angle, _direction, _leading, _time, _cycle, _temperature, _position, _unit,
)  # fmt: skip
