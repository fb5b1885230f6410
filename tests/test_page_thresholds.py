"""Thresholds that the pages on the diagnosis state are those of the code."""

from __future__ import annotations

import re
from math import exp
from pathlib import Path
from typing import NamedTuple

import pytest

from flexspline.geometry.ranges import TEMPERATURE_C
from flexspline.pipeline.diagnosis import (
    bend,
    decision,
    outcome,
    prediction,
    scale_error,
    slope_hints,
)
from flexspline.pipeline.diagnosis.causes import (
    friction_hysteresis,
    known_causes,
    micro_slip,
    thermal_clearance,
)
from flexspline.pipeline.diagnosis.end_points import decide as end_points_decide
from flexspline.pipeline.diagnosis.end_points import evidence as end_points_evidence
from flexspline.pipeline.diagnosis.end_points import finding
from flexspline.pipeline.diagnosis.measurement import (
    crossing_band,
    known_ways,
    lost_rows,
    lost_turns,
    noise,
    outliers,
    slow_runs,
    torque_jitter,
    torque_noise,
    torque_spikes,
    wrong_readings,
)
from flexspline.pipeline.diagnosis.model import doubt, extended_backlash
from flexspline.pipeline.diagnosis.specimens import decide as specimens_decide
from flexspline.pipeline.diagnosis.specimens import diagnose as specimens_diagnose
from flexspline.pipeline.diagnosis.specimens import evidence as specimens_evidence
from flexspline.pipeline.diagnosis.specimens import sensitivity
from flexspline.pipeline.diagnosis.sweep import (
    held_out,
    held_out_splits,
    local_bump,
    physical_limits,
)
from flexspline.pipeline.diagnosis.sweep.crossing import (
    crossing_likelihood,
    gap_crossing,
    torque_offset_guess,
)
from flexspline.pipeline.diagnosis.sweep.evidence import beam_search, fit
from flexspline.pipeline.diagnosis.sweep.identification import (
    identification,
    plausible_sets,
    rate_independence,
    rings_on,
)
from flexspline.pipeline.diagnosis.sweep.magnitudes import magnitudes
from flexspline.pipeline.diagnosis.sweep.nuisance import (
    basis_functions,
    channel_nuisance,
    rig_nuisance,
)
from flexspline.pipeline.diagnosis.sweep.race import friction_ahead_race, race
from flexspline.pipeline.diagnosis.sweep.residual import lack_of_fit, stick_slip_rests
from flexspline.pipeline.diagnosis.sweep.rig_faults import (
    angle_jumps,
    backward_loops,
    dragged_crossing,
    torque_delay,
    torque_zero_drift,
)
from flexspline.results.diagnosis import position_notes

DOCS = Path(__file__).parents[1] / "docs"
WORDS = {
    "two": 2, "three": 3, "four": 4, "five": 5, "seven": 7, "ten": 10, "thirteen": 13, "forty": 40,
    "twice": 2, "double": 2, "half": 1 / 2, "a quarter": 1 / 4, "third": 1 / 3, "a tenth": 1 / 10,
    "three quarters": 3 / 4, "nine tenths": 9 / 10, "nineteen of twenty": 19 / 20,
    "10⁻³": 1e-3,
}  # fmt: skip
"""Numbers that the pages spell out."""
NUMBER = "|".join([*sorted(WORDS, key=len, reverse=True), r"−?\d+(?:\.\d+)?"])


class Stated(NamedTuple):
    """A phrase of a page, {} where a number stands, and the code's values in that order."""

    page: str
    phrase: str
    values: tuple[float, ...]


def diagnosis(phrase: str, *values: float) -> Stated:
    return Stated("diagnosis.md", phrase, values)


def other_kinds(phrase: str, *values: float) -> Stated:
    return Stated("end-points-and-specimens.md", phrase, values)


def measured(phrase: str, *values: float) -> Stated:
    return Stated("measured-data.md", phrase, values)


STATED = [
    diagnosis("the residual is {} times the median, if these are {} of all at most",
              position_notes.STANDS_OUT_RATIO, position_notes.MOST_NAMED_SHARE),
    diagnosis("two factors agree within {} standard deviations", scale_error.SAME_FACTOR_DEVIATIONS),
    diagnosis("an F more than {} deviations from this place", friction_ahead_race.FAR_PLACE_DEVIATIONS),
    diagnosis("A friction torque below {} deviations of the torque's noise is not",
              gap_crossing.UNSEEN_SIGMAS),
    diagnosis("that power up to {} times the largest torque", micro_slip.THRESHOLD_RATIO),
    diagnosis("differs by up to {} of the span", thermal_clearance.SWING_SHARE),
    diagnosis("yield at {} the largest torque at most", friction_hysteresis.LARGEST_SHARP),
    diagnosis("that explains less than {} % of that one", 100 * local_bump.PART_SHARE),
    diagnosis("have more than {} % of the loop's rms", 100 * rings_on.LEAST_SHARE),
    diagnosis("Their periods range from {} rows", rig_nuisance.FEWEST_PERIOD_ROWS),
    diagnosis("within {} % of its largest value around a reversal", 100 * slow_runs.SLOW_RANGE_SHARE),
    diagnosis("Two tests must agree, each with a p-value of {}", stick_slip_rests.EITHER_P_VALUE),
    diagnosis("a separate zero at each position, if there are more than {}. At {} or fewer",
              *[channel_nuisance.MOST_AMBIGUOUS_POSITIONS] * 2),
    diagnosis("a parabola over that angle, if there are more than {} positions",
              channel_nuisance.MOST_AMBIGUOUS_POSITIONS),
    diagnosis("Up to {} cycles or positions also have a column", basis_functions.MANY_LEVELS),
    diagnosis("If the unexplained rms exceeds {} of what is named", decision.UNEXPLAINED_SHARE),
    diagnosis("If {} of their power cancel", 1 - 1 / plausible_sets.UNNAMED_TOGETHER**2),
    diagnosis("{} moves, each {} times the median move", angle_jumps.FEWEST_LEAPS, angle_jumps.LEAP_RATIO),
    diagnosis("joins the {} evenly spaced ones of each unit", channel_nuisance.TIME_STEPS),
    diagnosis("|T| below {} deviations of the torque's noise, or below {} % of the largest torque",
              crossing_band.BAND_SIGMAS, 100 * crossing_band.BAND_SHARE),
    diagnosis("single outliers beyond {} deviations. {} in a row",
              outliers.OUTLIER_SIGMAS, outliers.LONGEST_OUTLIER + 1),
    diagnosis("The noise may be {} or {} the estimate. The gap may have soft ends of {} %",
              crossing_likelihood.READINGS[0], crossing_likelihood.READINGS[-1],
              100 * crossing_likelihood.SOFTEST),
    diagnosis("their form is known to {} %", 100 * crossing_likelihood.FORM_DOUBT),
    diagnosis("middle of the gap is less than {} of the gap", gap_crossing.WITHIN_GAP),
    diagnosis("lags up to {} times the longest memory allowed, which is {} of a cycle",
              noise.LAGS_PER_MEMORY, noise.LONGEST_OF_CYCLE),
    diagnosis("A parabola through {} rows", 2 * torque_jitter.WIDEST_ROWS + 1),
    diagnosis("By chance, {} of 100 segments leave more than noise, and in {} of 100 records",
              100 * known_ways.REFUSED_BY_CHANCE, 100 * (1 - known_ways.RECORDS)),
    diagnosis("one cycle or unit has {} the typical noise", torque_noise.UNLIKE_RATIO),
    diagnosis("read torque in steps of {} to {} % of the largest torque",
              *[100 * share for share in torque_noise.COARSE_STEP]),
    diagnosis("If slow noise is larger than {} % of the twist", 100 * physical_limits.SLOW_SHARE),
    diagnosis("its size is uncertain by {} % of the wind-up", 100 * fit.GAP_BESIDE_WIND_UP),
    diagnosis("far apart in time: {} times as far as {} rows",
              lost_rows.LOST_STEPS, lost_rows.USUAL_QUANTILE),
    diagnosis("by more than {} rows' steps and {} deviations. It lies no further than {} times",
              lost_turns.MOVED_RIG_STEPS, lost_turns.MOVED_RIG_SIGMAS, lost_turns.LARGEST_TORQUE_RATIO),
    diagnosis("| a cause | {}: one of {}", round(beam_search.NAMED_COST, 1), len(known_causes())),
    diagnosis("| a further element | {} |", beam_search.ELEMENT_COST),
    diagnosis("| a nuisance term | {} |", beam_search.NUISANCE_COST),
    diagnosis("{} more sets of the same causes with other laws are tuned", race.TUNED_LAWS),
    diagnosis("- {} nats for a cause alone", identification.ALONE_NATS),
    diagnosis("- {} in addition to other causes with an assumed shape; only {} if",
              identification.SECOND_NATS, identification.STAND_IN_NATS),
    diagnosis("- {} for a compliance or a gap that stands alone", identification.STATED_NATS),
    diagnosis("Its size is {} deviations from no effect", outcome.SIZE_KNOWN),
    diagnosis("It has at least {} % of the rms of the largest cause", 100 * identification.MINOR_SHARE),
    diagnosis("are each {} times larger than their sum", plausible_sets.TOGETHER_RATIO),
    diagnosis("do not cancel {} of the curve over the torque", plausible_sets.UNDONE),
    diagnosis("comes within {} nats of evidence, or within {} of log likelihood",
              decision.RIVAL_EVIDENCE, decision.RIVAL_LIKELIHOOD),
    diagnosis("an unrecorded temperature by more than {} arcsec/K", thermal_clearance.MOST_PER_K),
    diagnosis("the rms of the nuisance terms exceeds {} the rms", decision.UNEXPLAINED_SHARE),
    diagnosis("A term that explains less than {} of this angle is not counted",
              plausible_sets.OF_TORQUE_NOISE),
    diagnosis("It must be {} nats better", rate_independence.FOLLOWS_NATS),
    diagnosis("of a cause with such a rival is {} at most", decision.EVEN_ODDS),
    diagnosis("{} of the loads do not run forwards", backward_loops.BACKWARD_SHARE),
    diagnosis("backwards on both sides of the gap by {} deviations", backward_loops.BACKWARD_DEVIATIONS),
    diagnosis("makes the loops equal, and {} of it as its uncertainty", torque_delay.FILTER_MISS),
    diagnosis("if a late form is {} nats better", torque_offset_guess.FIRST_NATS),
    diagnosis("if drag is {} nats better", torque_offset_guess.FIRST_NATS),
    diagnosis("the friction found differs by {} deviations", dragged_crossing.SAME_DEVIATIONS),
    diagnosis("is {} nats better than the other forms without them, and at most {} nats worse",
              torque_offset_guess.FIRST_NATS, decision.RIVAL_EVIDENCE),
    diagnosis("moves between the first and the last {} of a record", 1 / torque_zero_drift.PARTS),
    diagnosis("must be at least {} deviations, and large enough to cause {} of the drift",
              torque_zero_drift.MOVED_SIGMAS, torque_zero_drift.MADE_SHARE),
    diagnosis("temperature changes by less than {} K", thermal_clearance.STEADY_AIR_K),
    diagnosis("a thermal rival only up to {} arcsec/K", thermal_clearance.MOST_PER_K),
    diagnosis("other sets of shapes within {} nats", magnitudes.FEWEST_WEIGHT_LOGS * magnitudes.SHAPE_NATS),
    diagnosis("only if even growth is worse by {} nats", decision.RIVAL_EVIDENCE),
    diagnosis("several amplitudes ({} % apart), rates (factor {}) or temperatures ({} K)",
              100 * (exp(held_out_splits.AMPLITUDE_LEVELS.step) - 1),
              exp(held_out_splits.RATE_LEVELS.step), held_out_splits.TEMPERATURE_LEVELS.step),
    diagnosis("the causes at least {} the error of most levels", held_out.REFUTED_RATIO),
    diagnosis("is more than {} of the deviations stated there", held_out.REFUTING_DEVIATIONS),
    diagnosis("of one torque on one branch in {} cycles or more", lack_of_fit.FEWEST_RETURNS),
    diagnosis("explain more than {} as much as the causes did", decision.UNEXPLAINED_SHARE),
    other_kinds("p < {}, two-sided", finding.CORRECTED_P_VALUE),
    other_kinds("stated variance: {}, {} or {}", *end_points_evidence.CORRELATIONS),
    other_kinds("step of the file's angles to {} % of the median", 100 * end_points_evidence.LARGEST_READING),
    other_kinds("{} nats of evidence over the simulation", end_points_decide.OVER_SIMULATION_NATS),
    other_kinds("at least {} of its standard deviations from zero", outcome.SIZE_KNOWN),
    other_kinds("steps of a tolerance ({} to {} % of d)",
                100 * sensitivity.SMALLEST_STEP, 100 * sensitivity.LARGEST_DIMENSION_STEP),
    other_kinds("marginalised over {}–{} %, log-normal prior at {} %",
                100 * specimens_evidence.NOISES[0], 100 * specimens_evidence.NOISES[-1],
                100 * specimens_evidence.USUAL_NOISE),
    other_kinds("{} nats over the null", specimens_decide.OVER_NULL_NATS),
    other_kinds("fewer than {} specimens", specimens_diagnose.FEWEST_SPECIMENS),
    measured("outside {} to {} °C", TEMPERATURE_C.low, TEMPERATURE_C.high),
    measured("torque or angle is {} times as far from the median", wrong_readings.FAR_RATIO),
    measured("must be {} standard deviations, {} % of the largest torque, and {} times any",
             torque_spikes.SPIKE_SIGMAS, 100 * torque_spikes.SPIKE_SHARE, torque_spikes.SPIKE_STEPS),
    measured("move by less than {} of the twist", torque_spikes.LEAST_TWIST_SHARE),
    measured("if it is below {} or above {} °C, or jumps by more than {} K",
             wrong_readings.GEAR_C.low, wrong_readings.GEAR_C.high, wrong_readings.LEAP_K),
    measured("over the torque below {} % of the wind-up", 100 * bend.NUMERICAL_SHARE),
    measured("if a slope {} times softer", slope_hints.AS_GEAR),
    measured("of another unit to within about {} %", 100 * slope_hints.NEAR_FACTOR),
    measured("by {} of the causes' contribution there", doubt.BEYOND_THE_EDGE),
    measured("The time from 0 to T_L is {} minutes, the temperature is {} °C",
             extended_backlash.RAMP_S / 60, prediction.REFERENCE_C),
]  # fmt: skip
OF_BOTH_TABLES = "| rivals | {} nats of evidence or {} of penalised likelihood |"
"""In the rules of end points and in those of specimens."""


def page_text(page: str) -> str:
    """With single blanks."""
    return " ".join((DOCS / page).read_text(encoding="utf-8").split())


def found(text: str, phrase: str) -> list[re.Match[str]]:
    """Places of a phrase, whatever numbers stand there."""
    pattern = rf"({NUMBER})".join(map(re.escape, phrase.split("{}")))
    return list(re.finditer(pattern, text, re.IGNORECASE))


def value(number: str) -> float:
    return WORDS.get(number.lower()) or float(number.replace("−", "-"))


@pytest.mark.parametrize("stated", STATED, ids=lambda s: s.phrase)
def test_a_page_states_the_code_s_thresholds(stated: Stated) -> None:
    places = found(page_text(stated.page), stated.phrase)
    assert len(places) == 1, "write the phrase in this test as the page has it"
    assert [value(n) for n in places[0].groups()] == pytest.approx(list(stated.values), rel=1e-9)


def test_both_tables_state_when_a_cause_is_a_rival() -> None:
    places = found(page_text("end-points-and-specimens.md"), OF_BOTH_TABLES)
    limits = [decision.RIVAL_EVIDENCE, decision.RIVAL_LIKELIHOOD]
    assert [[value(n) for n in place.groups()] for place in places] == [limits, limits]


def unchecked(page: str, text: str) -> list[str]:
    """Numbers of nats and deviations, in a page's text, that no phrase above covers."""
    phrases = [OF_BOTH_TABLES, *(s.phrase for s in STATED if s.page == page)]
    covered = {
        p.start(i) for f in phrases for p in found(text, f) for i in range(1, p.re.groups + 1)
    }
    rule = rf"\b({NUMBER}) (?:(?:stated |standard )?deviations|nats)\b"
    return [m[0] for m in re.finditer(rule, text) if m.start(1) not in covered]


RESULTS = {
    "diagnosis.md": ["four stated deviations"],  # what 1 nat over the priors comes to
    "end-points-and-specimens.md": ["0.6 standard deviations"],  # of a unit in an example
    "measured-data.md": [],
}
"""Numbers that the rules lead to; no threshold."""


@pytest.mark.parametrize("page", RESULTS)
def test_no_threshold_in_nats_or_deviations_is_unchecked(page: str) -> None:
    assert unchecked(page, page_text(page)) == RESULTS[page]


def test_the_check_sees_a_new_threshold() -> None:
    text = "if it is 5 nats better, or within two standard deviations"
    assert unchecked("measured-data.md", text) == ["5 nats", "two standard deviations"]
