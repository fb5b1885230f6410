"""The next measurement in words: what to do, and what it distinguishes or confirms."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from math import ceil

from flexspline.geometry.listed import joined
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.rate_dependence import FASTER
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.decision import RIVAL_EVIDENCE
from flexspline.pipeline.diagnosis.diagnose import MeasurementKind
from flexspline.pipeline.diagnosis.end_points.next_measurement import TIMES_OVER
from flexspline.pipeline.diagnosis.outcome import Doing, DoingKind, NamedCause, NextMeasurement
from flexspline.pipeline.diagnosis.specimens.cause_ids import LOAD_ZONE, YOUNGS_MODULUS
from flexspline.pipeline.diagnosis.sweep.next_measurement import (
    AMPLITUDES,
    LONG_HOLD,
    MORE_CYCLES,
    POSITIONS_DEG,
    WARMER_K,
)
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.diagnosis.structure_words import words_of
from flexspline.results.diagnosis.words import title_of

CONFIRMS = {
    YOUNGS_MODULUS: "a tensile or resonance test of the same bar gives E directly",
    SERIES: "clamp a solid dummy in the same fixture: any twist then comes from the fixture",
    LOAD_ZONE: "measure specimens with another ring width, on which the effect of the lobes depends most",
}
"""What confirms a cause that specimens show."""

MOST_SPECIMENS = 100
"""Specimens of one dimension, above which their number is not advised. Judgement."""
LEAST_SEPARATION = 1e-3
"""Of predicted stiffnesses in units of noise: a smaller one is none."""

SLOWER, QUICKER = f"1/{FASTER:g}", f"{FASTER:g} times"
BOTH_RATES = f"repeat the sweep at {SLOWER} and at {QUICKER} the rate of torque"
POSITIONS = (
    f"repeat the sweep at {len(POSITIONS_DEG)} wave generator angles "
    f"{POSITIONS_DEG[1] - POSITIONS_DEG[0]:g}° apart, in mixed order"
)
FURTHER_CYCLES = f"run {MORE_CYCLES} further cycles at constant temperature"
COMPARE = (
    "compare the filters of the torque channel and the angle channel, and check that both are read at the "
    f"same time; then repeat the sweep at {SLOWER} of the rate of torque: "
)


def _sweep_to(shares: Sequence[float]) -> str:
    """Of the largest torque measured."""
    *others, last = (f"{share:g}" for share in shares)
    return f"sweep to {', '.join(others)} and {last} times the largest torque"


WITHIN = _sweep_to([share for share in AMPLITUDES if share <= 1])
OTHER_ORDER = (
    "repeat the sweep at the same temperatures in another order, soaked, wave generator untouched: an "
    "effect of time does not follow the temperature"
)
SHOWS_STRUCTURE = {
    "torque_Nm": f"{WITHIN}, each twice without a pause; an effect that repeats belongs to the gear, and its "
    "growth with the amplitude indicates the cause",
    "torque_amplitude": f"{WITHIN}, each twice",
    "torque_rate": BOTH_RATES,
    "angle_arcsec": "turn the encoder's housing on the output, or begin at another output angle, and "
    "repeat the sweep: an error of the encoder then appears at other torques, an effect of the gear at the "
    "same torques",
    "direction": "approach each of several torques from below and from above, twice each, and hold it: a "
    "difference from friction remains, a difference from a lag decays",
    "temperature_C": OTHER_ORDER,
    "input_angle_deg": POSITIONS,
    "time_s": "hold a constant torque as long as the whole record took, then repeat the first cycle",
    "row": "record time with every row, and repeat the sweep at once and after a pause as long as the "
    "record: the pause changes an effect of time, but not an effect of the number of cycles",
    "cycle": "record the temperature with every row, if the file has none; if the gear was clamped again "
    f"between cycles, give each clamping a name in the column unit and diagnose again; otherwise "
    f"{FURTHER_CYCLES} without touching the rig",
    "unit": "measure the units again in another order, and clamp each one again",
}
"""What shows structure in a channel, everything else held."""


DOING: Mapping[DoingKind, str] = {
    "whole_sweeps": "sweep the torque 0 → +T → 0 → −T → 0 twice, with at least 100 rows a cycle",
    "more_specimens": "measure at least eight specimens whose length, wall and diaphragm differ",
    "warmer": f"repeat the sweep {WARMER_K:g} K warmer, soaked, wave generator untouched",
    "other_rates": BOTH_RATES,
    "beyond_own_rates": f"repeat the sweep at {SLOWER} of its slowest cycle's rate of torque and at "
    f"{QUICKER} that of its quickest",
    "hold": f"hold the torque at both ends, each time for as long as {LONG_HOLD:g} ramps take",
    "larger_torque": "sweep to {torques} N·m",
    "other_positions": POSITIONS,
    "between_positions": "repeat the sweep at wave generator angles half way between those measured, in "
    "mixed order",
    "more_cycles": f"{FURTHER_CYCLES} and repeat the sweep",
    "slower": f"repeat the sweep at {SLOWER} of the rate of torque: drag then adds less torque, and the gap "
    "is crossed closer to the friction torque",
    "compare_channels": f"{COMPARE}the effect of a late reading is then {SLOWER} as large",
    "compare_channels_and_cell": f"{COMPARE}the loop of a late reading is then {SLOWER} as wide, that of "
    "a torque cell with hysteresis as wide as before",
    "weigh_torque_cell": "load and unload the torque cell with known weights, and compare its readings in "
    "both directions",
    "read_torque_zero": "unload the torque cell before the record, after it and every few cycles, and write "
    "down its reading",
    "same_ends": f"measure the same end points {TIMES_OVER} times",
    "other_ends": "measure end points at ± {torques} N·m",
    "closed_sweep": "measure a closed torque sweep 0 → +T → 0 → −T → 0, twice, at T = {torques} N·m",
    "closed_sweeps": "measure closed torque sweeps 0 → +T → 0 → −T → 0, loading and unloading, at T = "
    "{torques} N·m",
    "temperatures_in_other_order": OTHER_ORDER,
    "check_scales": "compare the angle reading with a known angle, and the torque reading with known "
    "weights: a wrong scale of either, or a softer material, changes the slope in the same way",
}
"""What a rig is to do."""


BEYOND: Collection[DoingKind] = ("larger_torque", "other_ends", "closed_sweeps")
"""Those that may go to larger torques than were measured."""


EXTENDS: Mapping[DoingKind, str] = {
    "larger_torque": "to extend this result to other torques",
    "between_positions": "to test this result at other positions, at any torque",
}
"""What confirms a cause that a record has shown."""


def doing_words(doing: Doing) -> str:
    """What to do."""
    words = DOING[doing.kind].format(torques=", ".join(f"{t:g}" for t in doing.torques_Nm))
    return words + _rated(doing) if doing.kind in BEYOND else words


def _rated(doing: Doing) -> str:
    """How the torques lie to the rated one, which no advice exceeds by itself."""
    if doing.rated_Nm is None:
        return ", as far as the gear's rated torque allows (gear.rated_torque_Nm is not stated)"
    rated = f"the rated torque of {doing.rated_Nm:g} N·m"
    if max(doing.torques_Nm) > doing.rated_Nm:
        return f" and not beyond: the record already exceeds {rated}"
    return f", within {rated}"


def why(after: NextMeasurement, kind: MeasurementKind, causes: Iterable[NamedCause] = ()) -> str:
    """What to measure next and why; `kind` of the diagnosed measurement, `causes` that were identified."""
    if after.aim == "more_data" and after.doing is not None:
        return doing_words(after.doing)
    sizes = {c.id: c.magnitude for c in causes}
    titles = [title_of(c, sizes.get(c, 0.0)) for c in after.causes]
    words = {"sweep": _of_sweep, "end_points": _of_end_points, "specimens": _of_specimens}[kind]
    return words(after, titles)


def _of_sweep(after: NextMeasurement, titles: Sequence[str]) -> str:
    if after.aim == "find_structure":
        if after.doing is not None:
            return doing_words(after.doing)
        where = f" ({words_of(after.structure, after.vary)})" if after.structure else ""
        how = SHOWS_STRUCTURE.get(
            after.vary, "vary only this channel and keep everything else constant"
        )
        return f"the structure lies in {channel_words(after.vary)}{where}: {how}"
    cause = known_causes()[after.causes[0]]
    if after.aim == "confirm":
        doing = cause.reveals if after.doing is None else doing_words(after.doing)
        if after.doing is not None and after.doing.kind in EXTENDS:
            to = EXTENDS[after.doing.kind]
            return f"the record determines {titles[0]} well; {to}: {doing}"
        return f"to confirm {titles[0]}: {doing}"
    separated = _one_from_others(titles)
    if after.doing is None or not after.separation:  # nothing was computed
        doing = cause.reveals if after.doing is None else doing_words(after.doing)
        return f"to distinguish {separated}: {doing}"
    difference = f"their predictions then differ by {after.separation:.0f} times the noise"
    return f"to distinguish {separated}: {doing_words(after.doing)}; {difference}"


def _of_end_points(after: NextMeasurement, titles: Sequence[str]) -> str:
    if after.aim == "find_structure":
        return "closed torque sweeps show the whole curve, not its ends"
    every = ", ".join(titles)
    reveals = known_causes()[after.causes[0]].reveals
    action = f"on unit {after.unit}: {reveals if after.doing is None else doing_words(after.doing)}"
    if after.aim != "separate":
        return f"{action}; this would confirm or rule out {every}"
    difference = (
        f"the two most similar of them then differ by {after.separation:.0f} times the noise"
    )
    if after.same_points is not None:
        difference += f" (end points at the same torques: {after.same_points:.1f})"
    return f"{action}; this distinguishes {every}: {difference}"


def _of_specimens(after: NextMeasurement, titles: Sequence[str]) -> str:
    if after.aim == "find_structure":
        what = words_of(after.structure, after.vary) if after.structure else after.vary
        return f"the structure is {what}: measure these specimens again, in another order"
    if after.aim == "confirm":
        test = CONFIRMS.get(after.causes[0])
        return (
            f"to confirm this cause: {test}" if test else f"measure {after.vary} of the specimens"
        )
    separated = _one_from_others(titles)
    if after.dimension_mm is None:
        return f"use another fixture, to distinguish {separated}"
    made, drawn = after.dimension_mm
    proposal = (
        f"measure a specimen with {after.vary} = {made:g} instead of {drawn:g}: the two most similar "
        f"predictions of its stiffness differ by {after.separation:.1f} times the noise"
    )
    if after.separation**2 >= 2 * RIVAL_EVIDENCE:
        return f"{proposal}; this distinguishes {separated}"
    needed = 2 * RIVAL_EVIDENCE / max(after.separation, LEAST_SEPARATION) ** 2
    if needed > MOST_SPECIMENS:
        return f"{proposal}, too little to distinguish {separated}; no other dimension is better"
    return f"{proposal}; about {ceil(needed)} such specimens are needed to distinguish {separated}"


def _one_from_others(titles: Sequence[str]) -> str:
    first, *others = titles
    return f"{first} from {joined(others, 'or')}"
