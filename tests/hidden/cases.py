"""Draws cases: a gear, a programme, an effect, noise; drawn again until the case is what it claims."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hidden.ahead import draw_friction_ahead
from hidden.bench import Bench
from hidden.case import Case
from hidden.clearance import draw_offset, draw_thermal, draw_wear
from hidden.effect import LEVELS, CannotShowError, Hidden, Setting
from hidden.elastic import (
    draw_asymmetry,
    draw_hardening,
    draw_position_stiffness,
    draw_series,
)
from hidden.foreign import KINDS, UNIT_GAIN, foreign, unit_gain
from hidden.friction import draw_friction
from hidden.micro_slip import draw_micro_slip
from hidden.plans import FOR_CAUSE, FOR_FOREIGN, FOR_FORM, TRAPS, away_from_reference
from hidden.program import Plan, Program
from hidden.reading import draw_kinematic, draw_torque_offset
from hidden.rig_faults import RIG_FAULTS
from hidden.slow import draw_creep, draw_drift, draw_rate
from hidden.surroundings import REFERENCE_C
from hidden.thermal_mass import draw_thermal_mass
from hidden.truth import CALIBRATED, standing

CAUSES: dict[str, Callable[[Setting, np.random.Generator], Hidden]] = {
    "friction_hysteresis": draw_friction,
    "stiffness_hardening": draw_hardening,
    "series_compliance": draw_series,
    "clearance_offset": draw_offset,
    "thermal_clearance": draw_thermal,
    "kinematic_error": draw_kinematic,
    "position_stiffness": draw_position_stiffness,
    "direction_asymmetry": draw_asymmetry,
    "creep": draw_creep,
    "wear": draw_wear,
    "sensor_drift": draw_drift,
    "torque_offset": draw_torque_offset,
    "rate_dependence": draw_rate,
}
FORMS: dict[str, tuple[str, Callable[[Setting, np.random.Generator], Hidden]]] = {
    "friction_ahead": ("friction_hysteresis", draw_friction_ahead),
    "micro_slip": ("friction_hysteresis", draw_micro_slip),
    "thermal_mass": ("thermal_clearance", draw_thermal_mass),
}
"""Further forms of a cause, by name; drawn only where asked for, so that old seeds keep their records."""
DECIDABLE = 6.0
"""Noise units, 18 nats, three times what docs/contract.md calls ambiguous."""
FOREIGN_STANDING = (12.0, 30.0, 90.0)
"""Noise units beyond the best two causes at the three levels; 10 are asked for."""
ONE_WAY = ("softening", "leading_output", "lock_slips", "lock_yields", "stick_slip")
"""Foreign effects whose reverse is something else."""
KEEP_WEAK = 0.2
"""Of the singles below that stay: a wrong name would be wrong there too."""
SHARES = {"clean": 0.2, "single": 0.39, "pair": 0.15, "foreign": 0.16, "undecidable": 0.1}
STRANGE = 4.0
"""Noise units that must speak against every cause but the rivals: 8 nats, where 6 are ambiguous."""
LIKE = 2.0
"""Noise units within which one shape of the rival must come: 2 nats, where 6 are ambiguous."""
ABSURD = 6.0
"""Arcsec/K: no gap of 70″ breathes by more, and a diagnosis may know it."""
TRIES = 300


class NoCaseError(RuntimeError):
    """Nothing decidable in `tries` draws of `what`."""

    def __init__(self, what: str, tries: int) -> None:
        self.what, self.tries = what, tries
        super().__init__(f"no {what} in {tries} draws")


def draw_case(seed: int, number: int, kind: str | None = None, cause: str | None = None) -> Case:
    """The case of that seed and number, the same every time.

    `kind` and `cause` (an id, one of FORMS, a foreign kind or a trap's name) narrow the draw.
    """
    rng = np.random.default_rng([seed, number])
    kinds = list(SHARES)
    kind = kind or str(rng.choice(kinds, p=[SHARES[k] for k in kinds]))
    make = {
        "clean": _clean, "single": _single, "pair": _pair, "triple": _triple, "foreign": _foreign,
    }  # fmt: skip
    names = {
        "foreign": [*KINDS, UNIT_GAIN],
        "single": [*CAUSES],
        "pair": [*CAUSES],
        "triple": [*CAUSES],
    }
    cause = cause or str(rng.choice(names.get(kind, [*TRAPS])))
    for _ in range(TRIES):
        case = make.get(kind, _undecidable)(rng, (seed, number), cause)
        if case is not None:
            return case
    raise NoCaseError(f"{kind} {cause or ''}", TRIES)


def _several(rng: np.random.Generator, chance: float) -> int:
    return int(rng.integers(2, 5)) if rng.random() < chance else 1


def _clean(rng: np.random.Generator, seed: tuple[int, int], cause: str) -> Case:
    bench = Bench(Plan(), rng, _several(rng, 0.1))
    return bench.case("clean", (), bench.measured(()), severity="", standing=(), seed=seed)


def _single(rng: np.random.Generator, seed: tuple[int, int], cause: str) -> Case | None:
    form = cause
    cause, draw = FORMS.get(form) or (form, CAUSES[form])
    level = int(rng.integers(3))
    bench = Bench(
        FOR_FORM.get(form) or FOR_CAUSE[cause],
        rng,
        1 if cause in CALIBRATED else _several(rng, 0.05),
    )
    try:
        hidden = draw(bench.setting(level), rng)
    except CannotShowError:  # the programme drawn cannot show this cause
        return None
    units = bench.measured((hidden,))
    left, rival = standing(units, bench.rig, (cause,)).single(0, cause)
    if left < DECIDABLE and rng.random() > KEEP_WEAK:
        return None
    case = bench.case(
        "single", (hidden,), units, severity=LEVELS[level], standing=(left,), seed=seed,
        decidable=left >= DECIDABLE,
    )  # fmt: skip
    return replace(case, said=f"{case.said}; nearest {rival}")


def _pair(rng: np.random.Generator, seed: tuple[int, int], cause: str) -> Case | None:
    return _together(rng, seed, cause, 2)


def _triple(rng: np.random.Generator, seed: tuple[int, int], cause: str) -> Case | None:
    return _together(rng, seed, cause, 3)


def _together(
    rng: np.random.Generator, seed: tuple[int, int], cause: str, count: int
) -> Case | None:
    """So many causes at once, each of which stands out beside all the others and one that is not there."""
    one, draw = FORMS.get(cause) or (cause, CAUSES[cause])
    plan, causes = FOR_CAUSE[one], [one]
    while len(causes) < count:
        causes.append(str(rng.choice([c for c in CAUSES if c not in causes])))
        both = _both(plan, FOR_CAUSE[causes[-1]])
        if both is None:
            return None
        plan = both
    level = int(rng.integers(3))
    bench = Bench(plan, rng)
    try:
        draws = [draw, *(CAUSES[c] for c in causes[1:])]
        hidden = tuple(make(bench.setting(level), rng) for make in draws)
    except CannotShowError:
        return None
    units = bench.measured(hidden)
    found = standing(units, bench.rig, tuple(causes))
    left = tuple(found.in_company(k, causes) for k in range(count))
    if min(left) < DECIDABLE:
        return None
    as_measured = tuple(_beside(h, [o for o in hidden if o is not h], bench) for h in hidden)
    kind = {2: "pair", 3: "triple"}[count]
    return bench.case(kind, as_measured, units, severity=LEVELS[level], standing=left, seed=seed)


def _beside(one: Hidden, others: list[Hidden], bench: Bench) -> Hidden:
    """An effect with the magnitude that docs/contract.md gives it beside the others."""
    for other in others:
        one = beside_a_spring(diluted(widened(one, other, bench), other, bench), other, bench)
    return one


def widened(friction: Hidden, other: Hidden, bench: Bench) -> Hidden:
    """Friction ahead of the teeth beside an elastic effect, which at T = 0 feels ± the friction torque."""
    if friction.teeth is None or other.cause not in ("series_compliance", "stiffness_hardening"):
        return friction
    gear, program = bench.gears[0], bench.program
    carried = np.abs(program.torque - friction.teeth(program, gear)).max()
    twist = other.angle(replace(program, torque=carried * np.array([-1.0, 1.0])), gear)
    return replace(friction, magnitude=friction.magnitude + float(twist[1] - twist[0]))


OF_TWIST = ("position_stiffness", "direction_asymmetry", "creep")
"""Causes whose magnitude is a share of the elastic twist, or of the mean compliance (docs/contract.md)."""


def diluted(share: Hidden, other: Hidden, bench: Bench) -> Hidden:
    """A share of the elastic twist beside a spring in series, which twists as well."""
    if share.cause not in OF_TWIST or other.cause != "series_compliance":
        return share
    gear = bench.gears[0]
    extra = float(other.angle(replace(bench.program, torque=np.ones(1)), gear)[0])
    return replace(share, magnitude=share.magnitude * gear.compliance / (gear.compliance + extra))


def beside_a_spring(hardening: Hidden, other: Hidden, bench: Bench) -> Hidden:
    """The ratio of chord stiffness that a gear shows with a spring in series, which does not harden."""
    if (hardening.cause, other.cause) != ("stiffness_hardening", "series_compliance"):
        return hardening
    gear, peak = bench.gears[0], bench.program.peak
    ends = replace(bench.program, torque=peak * np.array([0.05, 0.2, 0.8, 1.0]))
    twist = gear.compliance * ends.torque + hardening.angle(ends, gear) + other.angle(ends, gear)
    ratio = (0.2 / (twist[3] - twist[2])) / (0.15 / (twist[1] - twist[0]))
    return replace(hardening, magnitude=float(ratio))


def _foreign(rng: np.random.Generator, seed: tuple[int, int], cause: str) -> Case | None:
    kind = cause
    level = int(rng.integers(3))
    several = kind == UNIT_GAIN
    bench = Bench(FOR_FOREIGN.get(kind, Plan()), rng, int(rng.integers(3, 6)) if several else 1)
    only = int(rng.integers(len(bench.gears))) if several else None
    setting = bench.setting(level)
    try:
        shape, said = unit_gain(rng) if several else (KINDS | RIG_FAULTS)[kind](setting, rng)
        one = foreign(kind, shape, said, 1.0)
        found = standing(bench.measured((one,), only), bench.rig, (one.cause,))
    except CannotShowError:
        return None
    left = found.of_two(0)
    if left < 1e-6:
        return None
    alone = found.single(0, one.cause)[0]
    absorbed = float(np.sqrt(max(1 - (alone / found.beyond(0, ())) ** 2, 0)))
    size = FOREIGN_STANDING[level] * float(rng.uniform(0.9, 1.3)) / left
    if size > 0.35 * setting.windup:  # nobody would call that a gear
        return None
    shape_sign = 1 if kind in ONE_WAY else rng.choice([-1, 1])
    hidden = foreign(
        kind, shape, f"{said}, one cause mimics {absorbed:.2f} of it", size * shape_sign
    )
    units = bench.measured((hidden,), only)
    return bench.case(
        "foreign", (hidden,), units, severity=LEVELS[level], standing=(left * size,), seed=seed,
        foreign=kind, absorbed=absorbed,
    )  # fmt: skip


def _undecidable(rng: np.random.Generator, seed: tuple[int, int], cause: str) -> Case | None:
    trap = TRAPS[cause]
    plan = replace(trap.plan, extra=away_from_reference(rng)) if trap.away_C else trap.plan
    hide = str(rng.choice(trap.hide))
    level = int(rng.integers(3))
    bench = Bench(plan, rng)
    try:
        hidden = CAUSES[hide](bench.setting(level), rng)
    except CannotShowError:
        return None
    units = bench.measured((hidden,))
    found = standing(units, bench.rig, (hide,))
    left = {c: found.beyond(0, (c,)) for c in found.families if c != hide}
    rivals = trap.rivals - {hide}
    if trap.away_C and implied_per_kelvin(hidden.magnitude, hide, bench.program) > ABSURD:
        return None
    told = [c for c in rivals if found.beyond_one(0, c) > LIKE]
    beyond_others = min([found.beyond(0, ()), *(v for c, v in left.items() if c not in rivals)])
    if told or found.beyond(0, ()) < 1.5 * DECIDABLE or beyond_others < STRANGE:
        return None
    return bench.case(
        "undecidable", (hidden,), units, severity=cause, standing=(beyond_others,), seed=seed,
        decidable=False, expected=trap.rivals,
        tolerated=trap.rivals | {c for c, v in left.items() if v < DECIDABLE},
    )  # fmt: skip


def implied_per_kelvin(magnitude: float, cause: str, program: Program) -> float:
    """|arcsec/K| by which the one recorded temperature would have to explain the gap."""
    if cause == "thermal_clearance":
        return abs(magnitude)
    return abs(magnitude / (program.temperature[-1] - REFERENCE_C))


def _both(a: Plan, b: Plan) -> Plan | None:
    """A programme that shows both; None where their demands exclude each other."""
    common = {
        name: tuple(x for x in getattr(a, name) if x in getattr(b, name))
        for name in ("wave", "air", "places")
    }
    if not all(common.values()):
        return None
    return Plan(
        **common,
        cycles=(max(a.cycles[0], b.cycles[0]), max(a.cycles[1], b.cycles[1])),
        several_rates=a.several_rates or b.several_rates,
        with_columns=tuple({*a.with_columns, *b.with_columns}),
    )
