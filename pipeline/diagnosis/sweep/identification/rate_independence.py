"""Whether a rate dependence found beside friction follows the rate.

Friction of a form that no element has leaves a loop, and a rate dependence of a low exponent is one. Where
the record's cycles differ in rate, the two can be told: the same regressor, computed as if all cycles had run
at one rate, is a loop that knows no rate. If it explains the record as well, the rate has shown nothing.

Where all cycles run at one rate, only the form of the loop is left to tell the two apart. Friction whose
thresholds are spread in any way makes any loop whose branches bend one way and whose angle turns with the
torque, so the form tells only where one of the two has it by itself.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import holds
from flexspline.pipeline.diagnosis.measurement.ramps import by_travel, cycle_rate, moving_rates
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Candidate, Search
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    gaussian_evidence,
)

RATES_WITHIN = 1.9
"""Of the rates in a record at one rate, that nine tenths and one tenth of its travel are slower than. A
sine's are 2.3 apart, and its loop by the rate is round, by friction pointed. A triangle's are as far apart
as noise makes them, 1.6 at most: they are taken over steps of eight times the torque's."""
SLOW_AND_FAST = (0.1, 0.9)
"""Shares of the travel that are slower than the slow and the fast rate. Starts and turns lie in the tenths
beyond."""
RATES_APART = 1.2
"""Least ratio of the fastest cycle's rate to the slowest one's. A twist proportional to the rate then differs
by a fifth."""
FOLLOWS_NATS = 3.0
"""By which the rate must be better than the loop that knows none: in made-up records false ones gain at most
1.4, true ones 11 and more."""

LOOPS = {FRICTION: RATE, RATE: FRICTION}
"""Causes that open a loop, each with the other one."""
UNNAMED_LOOPS = ("?direction", "?torque_rate", "?torque_amplitude")
"""Owners of terms that open or bend a loop and have no name."""


def loop_tells(evidence: GaussianEvidence, best: Candidate, timed: bool) -> bool:
    """Whether a record can tell whose a loop is, friction's or the rate's.

    By cycles that differ in rate, or that hold the torque, over which a lag goes on and friction does not; at
    one rate by the form, where one of the two is enough: friction, for any loop of a rate on straight ramps
    is one of friction with thresholds of some spread; either, where the rate changes within the cycle. Never
    where time was not recorded (`timed`).
    """
    if not timed:
        return False
    history = evidence.columns.rig.history
    if _rates_or_holds(history):
        return True
    owners = best.owners
    rubs = FRICTION in owners or evidence.columns.ahead is not None
    if RATE in owners and rates_apart_within(history) < RATES_WITHIN:
        return False
    return not (rubs and RATE in owners) and owners.isdisjoint(UNNAMED_LOOPS)


def at_one_rate_on_ramps(history: History) -> bool:
    """Whether cycles run at one rate, straight and without holds: no row then parts friction from a lag."""
    return not _rates_or_holds(history) and rates_apart_within(history) < RATES_WITHIN


def _rates_or_holds(history: History) -> bool:
    """Whether cycles differ in rate, or hold the torque, over which a lag goes on and friction does not."""
    return cycle_rates(history) is not None or len(holds(history)) >= len(history.cycle_slices)


def follows_rate(evidence: GaussianEvidence, best: Candidate) -> bool:
    """Whether a set's rate dependence explains the record better than the loop that it is at one rate.

    True where the record has but one rate: nothing is then known against it.
    """
    history = evidence.columns.rig.history
    steady = at_one_rate(history)
    if steady is None:
        return True
    owners = best.owners
    columns = evidence.columns.all.copy()
    for term in evidence.terms:
        if term.owner == RATE and term.cause is not None:
            columns[:, term.at] = term.cause.columns(term.shape, steady)
    blind = gaussian_evidence(
        replace(evidence.columns, all=columns), evidence.target, evidence.kept, evidence.noise
    )
    loop = Search(blind, lambda term: term.owner in owners).run([best.terms])
    return best.score - loop.score >= FOLLOWS_NATS


def rates_apart_within(history: History) -> float:
    """The fastest over the slowest rate within units, by travel, without starts and turns; 1 without any."""
    apart = [1.0]
    for rows in history.unit_slices:
        if (rates := moving_rates(history, rows)) is None:
            continue
        slow, fast = (by_travel(rates.values, rates.travel_Nm, share) for share in SLOW_AND_FAST)
        apart.append(fast / slow if slow > 0 else 1.0)
    return max(apart)


def at_one_rate(history: History) -> History | None:
    """The history as if each cycle had run at the median one's rate; None where rates do not differ."""
    rates = cycle_rates(history)
    if history.time_s is None or rates is None:
        return None
    usual = float(np.median(rates[rates > 0]))
    stretch = np.ones(len(history))
    for rows, rate in zip(history.cycle_slices, rates, strict=True):
        if rate > 0:
            stretch[rows] = rate / usual
    time_s = history.time_s.copy()
    for rows in history.unit_slices:
        steps = np.diff(history.time_s[rows], prepend=history.time_s[rows[0]])
        time_s[rows] = history.time_s[rows[0]] + np.cumsum(steps * stretch[rows])
    return replace(history, time_s=time_s)


def cycle_rates(history: History) -> np.ndarray | None:
    """(c,) torque rate [N·m/s] of each cycle; None where cycles do not differ in it, or time is missing."""
    if history.time_s is None:
        return None
    rates = np.array([cycle_rate(history, rows) for rows in history.cycle_slices])
    if not (rates > 0).any() or rates.max() < RATES_APART * rates[rates > 0].min():
        return None
    return rates
