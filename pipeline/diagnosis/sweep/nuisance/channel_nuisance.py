"""Nuisance terms over time, cycle, temperature, position and unit."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.causes.operators import steadied, stops
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.temperature import temperature_without_noise
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm
from flexspline.pipeline.diagnosis.prediction import REFERENCE_C
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.nuisance.basis_functions import (
    MANY_LEVELS,
    less_fitted,
    levels,
    smooth,
    to_one,
    wave,
)
from flexspline.pipeline.diagnosis.sweep.nuisance.torque_nuisance import Made

TIME_STEPS = 25
"""Places of a step in time, evenly over a unit's rows: the nearest is within 2 % of them, and a sudden one is
tried at its own row (`../zero_jump.py`). Half or twice as many change no verdict of 12 made-up records
(`tests/hidden`, seed 77, every third of 34; nothing held out)."""
MOST_AMBIGUOUS_POSITIONS = 7
"""Positions up to here can be anything and yet be the harmonics 1, 2 and 4."""
WAVES = range(3, 61)
"""Half periods over the time of the record, by judgement: fewer are what `over_time` has. Half or twice as
many change no verdict of those 12."""
STEADY_K = 0.6
"""A temperature that varies by less is constant: at either end a usual sensor is within ±0.3 K (IEC 60751,
class B, at 0 °C), and a metal's stiffness changes by 0.03 %/K."""
LEAST_BENT = 0.02
"""Share of the square's own size. If temperatures lie at two levels or close together, no bend is visible."""
TURNS_DEGREE = 2
"""Of the polynomial over the wave generator's angle: of a sine over an eighth of its period, an eccentric
encoder's error in 4 to 20 input turns, it leaves 0.3 % of the amplitude."""
FRICTION_THRESHOLDS = (0.01, 0.015, 0.02, 0.03, 0.045, 0.06, 0.08, 0.1, 0.13, 0.17, 0.25, 0.4)
"""Shares of the largest torque at which friction that changes slips. No tuning moves them as those of named
friction: by 0.02, 0.06 and 0.15 alone a single slider at 0.08 was missed by a twentieth of its loop, which
passed for ringing, a lock or a rate dependence."""
CHANGING_DEGREE = 3
"""Of the polynomial by which it changes: a loop that halves with every 17 K is within 1 % of it over 55 K."""
DEGREES = (1, 2, 3)
"""Degrees of the polynomial in time of a changing stiffness or gain: steady, with a bend, with a turn."""


def _passed(rig: FitContext) -> np.ndarray | None:
    """(n,) time since each unit's first row, of the longest unit's; None without time."""
    if rig.duration_s <= 0 or rig.history.time_s is None:
        return None
    t = np.zeros(len(rig.history))
    for rows in rig.history.unit_slices:
        t[rows] = (rig.history.time_s[rows] - rig.history.time_s[rows[0]]) / rig.duration_s
    return t


def over_time(rig: FitContext) -> Made:
    """A smooth drift of the zero."""
    t = _passed(rig)
    if t is not None:
        yield "time_s", UnnamedForm("smooth"), smooth(2 * t - 1)


def changing_stiffness(rig: FitContext) -> Made:
    """Stiffness that changes with time by a polynomial."""
    t = _passed(rig)
    if t is None:
        return
    torque = rig.history.torque_Nm / rig.largest_Nm
    for degree in DEGREES:
        powers = np.column_stack([t**k for k in range(1, degree + 1)])
        yield "time_s", UnnamedForm("changing_stiffness"), torque[:, None] * powers


def changing_gain(rig: FitContext) -> Made:
    """A gain of the angle's channel that changes with time by a polynomial: so does the gap's step."""
    t = _passed(rig)
    if t is None:
        return
    angle = to_one(rig.prediction.for_race.angle_arcsec(rig.history))
    for degree in DEGREES:
        powers = np.column_stack([t**k for k in range(1, degree + 1)])
        yield "time_s", UnnamedForm("changing_gain"), angle[:, None] * powers


def waves_and_steps(rig: FitContext) -> Made:
    """Zeros that oscillate, or jump once in one unit."""
    t = _passed(rig)
    if t is None:
        return
    for k in WAVES:
        yield "time_s", UnnamedForm("wave"), wave(t, k)
    for rows in rig.history.unit_slices:
        for place in np.linspace(0, 1, TIME_STEPS + 2)[1:-1]:
            yield from step_from(rig, int(rows[int(place * len(rows))]))


def step_from(rig: FitContext, row: int) -> Made:
    """The zero jumps at a row, until its unit ends."""
    unit = rig.history.unit
    after = (unit == unit[row]) & (np.arange(len(unit)) >= row)
    of_one = int(unit[row]) + 1 if len(rig.history.unit_slices) > 1 else 0
    yield "time_s", UnnamedForm("step", of_one), after[:, None].astype(float)


def over_cycle(rig: FitContext) -> Made:
    """Zero, stiffness and gap of each cycle, and a stiffness that changes steadily or ever more slowly."""
    if rig.cycles < 2:
        return
    own = levels(rig.history.cycle.astype(float))
    torque = rig.history.torque_Nm / rig.largest_Nm
    yield "cycle", UnnamedForm("own_zero"), own
    yield "cycle", UnnamedForm("own_stiffness"), own * torque[:, None]
    ramp = rig.history.cycle / (rig.cycles - 1)
    for power in (1.0, 0.5):
        yield (
            "cycle",
            UnnamedForm("changing_stiffness"),
            (ramp**power * torque)[:, None],
        )
    yield "cycle", UnnamedForm("own_gap"), own * rig.history.sign[:, None]


def over_temperature(rig: FitContext) -> Made:
    """What temperature can do beside a gap linear in it.

    Of a gap that is not linear only what no linear one can be: one that grew as (ϑ − 20 °C)² alone would not
    change with temperature at 20 °C at all, and no material does that.
    """
    temperature = rig.history.temperature_C
    if temperature is None or np.ptp(temperature_without_noise(rig.history)) < STEADY_K:
        return
    torque = rig.history.torque_Nm / rig.largest_Nm
    warm = to_one(temperature - REFERENCE_C)
    centred = 2 * (temperature - temperature.min()) / np.ptp(temperature) - 1
    yield "temperature_C", UnnamedForm("changing_zero"), warm[:, None]
    yield "temperature_C", UnnamedForm("changing_zero"), smooth(centred, 3)
    yield "temperature_C", UnnamedForm("changing_stiffness"), (warm * torque)[:, None]
    side = rig.history.sign
    linear = np.column_stack([side, warm * side])
    curved = warm**2 * side
    bent = less_fitted(curved, linear)
    if np.std(bent) > LEAST_BENT * np.std(curved):
        yield "temperature_C", UnnamedForm("bent_gap"), bent[:, None]


def changing_friction(rig: FitContext) -> Made:
    """Friction that runs in, or that follows the grease's temperature: loops of another width each time.

    The whole loop is in it: beside one of a single width, which has a name, what changes would be a trace.
    """
    history = rig.history
    thresholds = np.array(FRICTION_THRESHOLDS) * rig.largest_Nm
    torque = steadied(history, deadband_Nm(history))
    states = stops(history, torque, thresholds, np.zeros(len(thresholds))) / thresholds
    temperature = history.temperature_C
    warm = None
    if temperature is not None and np.ptp(temperature_without_noise(history)) >= STEADY_K:
        warm = 2 * (temperature - temperature.min()) / np.ptp(temperature) - 1
    for state in states.T:
        if rig.cycles > 2:
            own = levels(history.cycle.astype(float))
            for changes in (smooth(_progress(history), CHANGING_DEGREE), own):
                columns = np.column_stack([np.ones(len(state)), changes]) * state[:, None]
                yield "cycle", UnnamedForm("changing_loop"), columns
        if warm is not None:
            changes = smooth(warm, CHANGING_DEGREE)
            columns = np.column_stack([np.ones(len(warm)), changes]) * state[:, None]
            yield "temperature_C", UnnamedForm("changing_loop"), columns


def _progress(history: History) -> np.ndarray:
    """(n,) cycles that have passed in each unit, its parts of a cycle too, from −1 to 1."""
    passed = np.zeros(len(history))
    for rows in history.cycle_slices:
        passed[rows] = history.cycle[rows] + np.arange(len(rows)) / len(rows)
    return np.asarray(2 * passed / (history.cycle.max() + 1) - 1)


def zeros_apart(rig: FitContext) -> Made:
    """A zero of each cycle's and of each position's own, none shared with its neighbours."""
    if rig.cycles > 1:
        yield "cycle", UnnamedForm("own_zero"), levels(rig.history.cycle.astype(float), MANY_LEVELS)
    if _telling(rig):
        assert rig.history.input_angle_deg is not None
        position = np.mod(rig.history.input_angle_deg, 360.0)
        yield "input_angle_deg", UnnamedForm("own_zero"), levels(position, MANY_LEVELS)


def _telling(rig: FitContext) -> bool:
    """Whether zeros of the record's positions may be something else than the harmonics 1, 2 and 4."""
    angle = rig.history.input_angle_deg
    return angle is not None and len(np.unique(np.mod(angle, 360.0))) > MOST_AMBIGUOUS_POSITIONS


def over_position(rig: FitContext) -> Made:
    """Zero, stiffness and gap of each position's own."""
    angle = rig.history.input_angle_deg
    if angle is None or np.ptp(angle) == 0:
        return
    torque = rig.history.torque_Nm / rig.largest_Nm
    own = levels(np.mod(angle, 360.0))
    if _telling(rig):
        yield "input_angle_deg", UnnamedForm("own_zero"), own
        yield "input_angle_deg", UnnamedForm("own_stiffness"), own * torque[:, None]
    yield "input_angle_deg", UnnamedForm("own_gap"), own * rig.history.sign[:, None]


def over_turns(rig: FitContext) -> Made:
    """A zero that goes on with the wave generator's angle, not periodic in it.

    So does an eccentric encoder's at the output, in part of an output turn. Where positions are taken in
    order it is a drift in steps from cycle to cycle, and where turns alias a kinematic error. Few positions
    are left to that. Readings within one turn go on over its end, by less than half a turn at a time.
    """
    angle = rig.history.input_angle_deg
    if angle is None:
        return
    if np.ptp(angle) <= 360.0:
        angle = np.unwrap(angle, period=360.0)
    if len(np.unique(angle)) <= MOST_AMBIGUOUS_POSITIONS:
        return
    turned = 2 * (angle - angle.min()) / np.ptp(angle) - 1
    for degree in range(1, TURNS_DEGREE + 1):
        yield "input_angle_deg", UnnamedForm("changing_zero"), smooth(turned, degree)


def over_unit(rig: FitContext) -> Made:
    """Stiffness and gap of each unit's own."""
    units = rig.history.unit_slices
    if len(units) < 2:
        return
    torque = rig.history.torque_Nm / rig.largest_Nm
    for u, rows in enumerate(units):
        own = np.zeros(len(torque))
        own[rows] = 1.0
        yield "unit", UnnamedForm("own_stiffness", u + 1), (own * torque)[:, None]
        yield "unit", UnnamedForm("own_gap", u + 1), (own * rig.history.sign)[:, None]
