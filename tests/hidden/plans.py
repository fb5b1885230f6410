"""Which torque programmes a rig would run to see an effect, and which cannot tell."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from hidden.program import Plan

HELD = ("staircase", "trapezoid")
MOVING_AIR = ("ramp", "oven", "heating", "shuffled", "swing")
MANY_PLACES = ("even", "random", "revisited")

FOR_CAUSE: dict[str, Plan] = {
    "friction_hysteresis": Plan(several_rates=True, with_columns=("time_s",)),
    "stiffness_hardening": Plan(),
    "series_compliance": Plan(places=("none", *MANY_PLACES), cycles=(3, 8)),
    "clearance_offset": Plan(air=("none", *MOVING_AIR), cycles=(3, 8)),
    "thermal_clearance": Plan(air=MOVING_AIR, with_columns=("temperature_C",), cycles=(3, 8)),
    "kinematic_error": Plan(
        places=MANY_PLACES, with_columns=("input_angle_deg", "cycle", "time_s"), cycles=(5, 14)
    ),
    "position_stiffness": Plan(
        places=MANY_PLACES, with_columns=("input_angle_deg", "cycle", "time_s"), cycles=(5, 14)
    ),
    "direction_asymmetry": Plan(),
    "creep": Plan(wave=HELD, with_columns=("time_s",)),
    "wear": Plan(with_columns=("cycle",), cycles=(3, 8)),
    "sensor_drift": Plan(with_columns=("time_s",)),
    "torque_offset": Plan(),
    "rate_dependence": Plan(several_rates=True, with_columns=("time_s",)),
}
"""A loop under friction is told from one under rate by several rates: those two get them."""

FOR_FORM: dict[str, Plan] = {
    "micro_slip": Plan(
        several_rates=True, several_peaks=True, with_columns=("time_s",), cycles=(3, 8)
    ),
    "thermal_mass": Plan(
        air=("ramp", "heating", "swing", "oven"),
        with_columns=("temperature_C", "time_s"),
        cycles=(4, 8),
    ),
}
"""Of forms that only other programmes than their cause's show: micro-slip has no loop of one size."""

FOR_FOREIGN: dict[str, Plan] = {
    "slow_wave": Plan(with_columns=("time_s",), cycles=(3, 8)),
    "zero_step": Plan(with_columns=("time_s", "cycle"), cycles=(3, 8)),
    "zero_with_temperature": Plan(air=MOVING_AIR, with_columns=("temperature_C",), cycles=(3, 8)),
    "stiffness_with_temperature": Plan(
        air=MOVING_AIR, with_columns=("temperature_C",), cycles=(3, 8)
    ),
    "stiffness_with_cycle": Plan(with_columns=("cycle",), cycles=(3, 8)),
    "zero_each_cycle": Plan(
        with_columns=("cycle",), cycles=(4, 8), places=("none", "constant", "revisited")
    ),
    "position_step": Plan(
        places=("even", "random"), with_columns=("input_angle_deg", "cycle"), cycles=(12, 24)
    ),
    "hum": Plan(with_columns=("time_s",), rows=(800, 3000), cycles=(2, 5)),
    "leading_output": Plan(with_columns=("time_s",)),
    "lock_slips": Plan(with_columns=("time_s",), cycles=(3, 8)),
    "lock_yields": Plan(with_columns=("time_s",), cycles=(3, 8)),
    "ringing": Plan(
        wave=("triangle", "staircase", "trapezoid"),
        with_columns=("time_s",),
        rows=(1000, 3000),
        cycles=(2, 5),
    ),
    "stick_slip": Plan(with_columns=("time_s",), rows=(600, 3000)),
    "tooth_ripple": Plan(
        places=("even", "random"), with_columns=("input_angle_deg", "cycle"), cycles=(9, 24)
    ),
}


@dataclass(frozen=True)
class Trap:
    """A design that cannot tell: its plan, what may be hidden in it, the rivals."""

    plan: Plan
    hide: tuple[str, ...]
    rivals: frozenset[str]
    away_C: bool = False
    also: dict = field(default_factory=dict)


_PLAIN = Plan(wave=("triangle",), several_rates=False, several_peaks=False)
TRAPS: dict[str, Trap] = {
    "temperature rises with the cycles": Trap(
        Plan(air=("rise",), cycles=(3, 8), with_columns=("temperature_C", "cycle", "time_s"),
             several_rates=False),
        ("wear", "thermal_clearance"),
        frozenset({"wear", "thermal_clearance"}),
    ),
    "one loading rate": Trap(
        replace(_PLAIN, with_columns=("time_s",)),
        ("friction_hysteresis", "rate_dependence"),
        frozenset({"friction_hysteresis", "rate_dependence"}),
    ),
    "no time column": Trap(
        replace(_PLAIN, without=("time_s",)),
        ("friction_hysteresis", "rate_dependence"),
        frozenset({"friction_hysteresis", "rate_dependence"}),
    ),
    "one position": Trap(
        Plan(places=("constant",), with_columns=("input_angle_deg",)),
        ("series_compliance", "position_stiffness"),
        frozenset({"series_compliance", "position_stiffness"}),
    ),
    "one temperature away from 20 °C": Trap(
        Plan(air=("constant",), with_columns=("temperature_C",)),
        ("clearance_offset", "thermal_clearance"),
        frozenset({"clearance_offset", "thermal_clearance"}),
        away_C=True,
    ),
    "torque one way only": Trap(
        Plan(wave=("triangle", "sine"), one_sided=True, places=("none",)),
        ("series_compliance",),
        frozenset({"series_compliance", "direction_asymmetry"}),
    ),
    "torque one way only, in time": Trap(  # one side of the gap: its growth moves the zero
        Plan(wave=("triangle", "sine"), one_sided=True, places=("none",), air=("none",),
             several_rates=False, with_columns=("time_s", "cycle"), cycles=(3, 8)),
        ("wear", "sensor_drift"),
        frozenset({"wear", "sensor_drift"}),
    ),
}  # fmt: skip


def away_from_reference(rng: np.random.Generator) -> dict[str, float]:
    """A constant temperature 5 to 18 K from 20 °C."""
    return {"constant_C": 20 + float(rng.uniform(5, 18) * rng.choice([-0.6, 1], p=[0.3, 0.7]))}
