"""The race with and without friction ahead of the teeth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import AHEAD, FRICTION
from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING, LAWS
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.sweep.crossing.friction_ahead_guess import (
    AheadGuess,
    first_ahead,
    frictions_alike,
)
from flexspline.pipeline.diagnosis.sweep.crossing.gap_crossing import (
    UNSEEN_SIGMAS,
    WITHIN_GAP,
    Crossing,
    between_rows,
    crossing,
)
from flexspline.pipeline.diagnosis.sweep.evidence.fit import LINEAR
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import (
    PreparedSweep,
    TooFewRowsError,
    prepare,
    true_history,
)
from flexspline.pipeline.diagnosis.sweep.race.friction_ahead_tuning import (
    TunedAhead,
    ahead_element,
    tuned_ahead,
)
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep, FoundAhead, run_race
from flexspline.pipeline.diagnosis.sweep.race.torque_offset_race import (
    gained,
    offset_of,
    with_torque_offset,
)

PRESUMED_TERMS: Mapping[str, Mapping[str, float]] = {
    RATE: {"exponent": 1.0},
    HARDENING: {"law": LAWS["tanh"], "held": 0},
}
"""Terms that stand beside the friction before any race, by cause, of the shapes that have these parameters:
linear lags, and a soft wind-up at several scales."""
NEVER = {"": 0.0}
"""Parameters that no shape has."""
AHEAD_RACES = 3
"""Races at most, each with the friction that the last one's terms make the best: 8 made-up records with such
friction (`tests/hidden`, seed 77) settle after one or two."""
RACES_OF_BOTH = 6
"""The same beside a shifted reading, whose place and the friction's move each other: twice as many, by
judgement."""
AHEAD_SETTLED_SHARE, SETTLED_LOG = 0.003, 0.3
"""Friction found again within this of the largest torque, and its stiffness ratio within this of its log, is
the last: neither moves what counts."""
AHEAD_NATS = 9.0
"""[nats] Least evidence over none: odds of 8000 to 1, twice what a cause costs; as for an offset of the
torque reading."""
SURE_NATS = 30.0
"""Nats of the step's place by which it needs no race without it to be sure, beyond what it leaves to terms
without a name, to which such a race might give one: of 220 made-up records without
such friction (`tests/hidden`, seed 90817) one has more than 12, a pair with a shifted reading: 13."""
PLACE_BETWEEN_ROWS, PASSED_OVER = 0.5, 3
"""Of the torque between the rows next to a crossing: its place is not known better. The third nearest on
either side count: rows that noise or a jump has moved are passed over. So are rows still in the gap: drag or
soft ends spread its crossing over torques, at none of which alone it is crossed."""
FAR_PLACE_DEVIATIONS = 3.0
"""Deviations of the crossing's place, from which what the loop's shape says is not taken: the deviation is
half of what no row tells apart."""
GUESS_LOG = 0.2
"""Of the first guess, which the step of the gap gives: on 14 records whose friction is known it was up to 9 %
off. Where the shape of the loop says something farther away, other friction bends it, unless the step fits
as well there: between rows far apart it has no place of its own."""
BEYOND_BOTH = 1.2
"""Times the larger of the guess and what the loop's shape says: so far such places are looked for."""

UNMEASURED_SHARE = 0.2
"""Of the friction's torque, from which its deviation says that it is not measured: beside a shifted reading
whose rows at zero torque lie in the gap it was 0.26 and 1.05, of true friction 0.05 at most. Friction is then
held against a race without it, as is a loop of less rms than the noise."""
OTHER_FRICTION_LOG = 0.7
"""Of a guess over what the race makes of it: where drag spreads the gap's crossing it was 1.65 times too
large; a gap that swung with the temperature made one 2.7 times that of the race."""


def with_friction_ahead(prepared: PreparedSweep) -> ExplainedSweep | None:
    """The race with friction ahead of the teeth; None where the record shows nothing like it.

    Where only a race without it can decide, the better explained of the two.
    """
    history, gap = true_history(prepared.sweep), prepared.prediction.gap_arcsec
    guess = first_ahead(history, prepared.sweep.angle_arcsec, gap, prepared.band_Nm)
    if guess is None:
        return None
    try:
        raced, std = _raced_with(prepared, guess)
    except TooFewRowsError:
        return None
    if not _seen(raced):
        return None
    is_sure = _is_guessed(raced, guess.friction_Nm) and _is_measured(raced, std)
    nats = guess.nats if is_sure else 0.0
    if nats < SURE_NATS + _unnamed_nats(raced):
        plain = run_race(prepared)
        gain = gained(raced, plain)
        if (
            nats < SURE_NATS or gain < AHEAD_NATS
        ):  # else the guess is surer than of any shifted reading
            plain = with_torque_offset(plain)
            gain = gained(raced, plain)
        if gain < AHEAD_NATS:
            return plain
        nats = gain
    return replace(raced, ahead=FoundAhead(std, nats))


def _seen(raced: ExplainedSweep) -> bool:
    """Whether the friction stands out of the torque's noise, in which rows lie on either side anyhow."""
    ahead = raced.prepared.ahead
    assert ahead is not None
    return ahead.amplitudes[0] > UNSEEN_SIGMAS * torque_noise_Nm(raced.prepared.rig.history)


def _is_guessed(raced: ExplainedSweep, friction_Nm: float) -> bool:
    """Whether the race has about the friction that was guessed, of whose place the guess is sure: a gap that
    moves between cycles may look like some."""
    ahead = raced.prepared.ahead
    assert ahead is not None
    return abs(float(np.log(ahead.amplitudes[0] / friction_Nm))) < OTHER_FRICTION_LOG


def _is_measured(raced: ExplainedSweep, std_Nm: float) -> bool:
    """Whether the race knows the friction's torque, and sees its loop: what it has bent to something else, it
    does not."""
    ahead, identified = raced.prepared.ahead, raced.identified
    assert ahead is not None
    known = std_Nm < UNMEASURED_SHARE * ahead.amplitudes[0]
    return known and identified.rms[FRICTION] > raced.prepared.noise.std_arcsec


def _unnamed_nats(raced: ExplainedSweep) -> float:
    """Of the evidence, what terms without a name have."""
    search, best = raced.identified.search, raced.identified.best
    named = [i for i in best.terms if search.evidence.terms[i].cause is not None]
    return best.log_evidence - search.candidate(named).log_evidence


def _raced_with(plain: PreparedSweep, guess: AheadGuess) -> tuple[ExplainedSweep, float]:
    """The race with friction, and the friction found again from it; with the deviation of its torque."""
    element, offset = _begun(plain, guess), guess.offset_Nm
    seen: Crossing | None = None
    for _ in range(RACES_OF_BOTH if offset else AHEAD_RACES):
        explained = run_race(prepare(plain.sweep, plain.prediction, offset, element))
        now = explained.prepared
        seen = seen or _crossing(
            explained
        )  # the first: later fits have bent towards their friction
        tuned = _tuned(explained, seen)
        if seen is not None:
            tuned = _held_at(tuned, seen)
        shifted = offset_of(explained)
        if not offset and abs(shifted) < _step_across(now.rig.history):
            shifted = 0.0
        moved = abs(tuned.element.amplitudes[0] - element.amplitudes[0])
        bent = abs(float(np.log(tuned.element.shape[AHEAD] / element.shape[AHEAD])))
        settled = AHEAD_SETTLED_SHARE * plain.rig.largest_Nm
        if moved < settled and bent < SETTLED_LOG and abs(shifted - offset) < settled:
            break
        element, offset = tuned.element, shifted
    return explained, tuned.torque_std_Nm


def _begun(plain: PreparedSweep, guess: AheadGuess) -> Element:
    """What a race begins with: the friction that the loop's shape says, where the gap's step allows it."""
    history, gap = true_history(plain.sweep), plain.prediction.gap_arcsec
    first = ahead_element(guess.friction_Nm, history)
    tuned = _alone(prepare(plain.sweep, plain.prediction, guess.offset_Nm, first)).element
    friction = tuned.amplitudes[0]
    if abs(float(np.log(friction / guess.friction_Nm))) < GUESS_LOG:
        return tuned
    most = BEYOND_BOTH * max(friction, guess.friction_Nm)
    low, high = frictions_alike(history, plain.sweep.angle_arcsec, gap, guess, most)
    inside = (f for f in (friction, guess.friction_Nm) if low <= f <= high)
    return replace(tuned, amplitudes=(next(inside, (low + high) / 2),))


def _tuned(explained: ExplainedSweep, seen: Crossing | None) -> TunedAhead:
    """The friction tuned beside the race's best set, or beside less of it where that is likelier.

    Friction behind the gap makes up for friction ahead of another torque or stiffness than the gear's: it
    stays where it is needed beside the best friction ahead.
    """
    search, terms = explained.identified.search, explained.identified.best.terms
    with_friction = tuned_ahead(explained.prepared, search.evidence, terms, seen)
    less = tuple(i for i in terms if search.evidence.terms[i].owner != FRICTION)
    if less == terms:
        return with_friction
    without = tuned_ahead(explained.prepared, search.evidence, less, seen)
    more_needed = with_friction.nats + search.prior(terms) - without.nats - search.prior(less)
    return with_friction if more_needed > 0 else without


def _held_at(tuned: TunedAhead, seen: Crossing) -> TunedAhead:
    """Moved to where the gap is crossed, if it lies far from there.

    Friction of another kind bends the loop as this does; the step of the gap is this one's alone.
    """
    friction = tuned.element.amplitudes[0]
    if abs(friction - seen.offset_Nm) < FAR_PLACE_DEVIATIONS * seen.std_Nm or seen.offset_Nm <= 0:
        return tuned
    element = replace(tuned.element, amplitudes=(seen.offset_Nm,))
    return replace(tuned, element=element, torque_std_Nm=seen.std_Nm)


def _alone(prepared: PreparedSweep) -> TunedAhead:
    """The friction that explains the record best beside what a gear without it does with its torque.

    Stiffness, gap, lags and a soft wind-up: a lag opens the loop as friction does, and a wind-up bends it
    near the gap, but neither moves the gap's step. Without them the friction would be as large as all.
    """
    few = prepared.columns.only(
        lambda t: (
            t.owner in LINEAR or PRESUMED_TERMS.get(t.owner, NEVER).items() <= dict(t.shape).items()
        )
    )
    evidence = gaussian_evidence(few, prepared.target, prepared.kept, prepared.noise)
    return tuned_ahead(prepared, evidence, range(len(few.terms)))


def _crossing(explained: ExplainedSweep) -> Crossing | None:
    """The friction torque [N·m] at which the gap is crossed each way, None where that cannot be seen."""
    prepared, fit = explained.prepared, explained.identified.fit
    assert prepared.ahead is not None
    history = prepared.rig.history
    friction = prepared.ahead.amplitudes[0]
    way = direction_of_loading(true_history(prepared.sweep, prepared.offset_Nm))
    good = ~prepared.outlier & (way != 0)
    along, height = way * history.torque_Nm + friction, way * fit.left_but_for_gap()
    along, height, gap = along[good], height[good], fit.gap_arcsec()[good]
    noise = prepared.noise.std_arcsec
    place = crossing(along, height, gap, noise, torque_noise_Nm(history))
    if place is None:
        return None
    beside = np.abs(height) > WITHIN_GAP * gap
    between = PLACE_BETWEEN_ROWS * between_rows(along[beside], place.offset_Nm, PASSED_OVER)
    return replace(place, std_Nm=max(place.std_Nm, between))


def _step_across(history: History) -> float:
    """Torque [N·m] between the two rows of a crossing, typically: its place is somewhere between them."""
    crossed = (np.diff(history.sign) != 0) & (np.diff(history.unit) == 0)
    steps = np.abs(np.diff(history.torque_Nm))[crossed]
    return float(np.median(steps)) if len(steps) else 0.0
