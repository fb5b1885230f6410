"""Units under test that differ: each is judged by its own rows.

One gear of three may drift, or have another position error. All rows together then show a mean of an effect
and of none, and its misfit in each unit has no cause.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import hypot, sqrt

import numpy as np

from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.torque_offset import OFFSET
from flexspline.pipeline.diagnosis.decision import Decision
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.outcome import SIZE_KNOWN, NamedCause, none_of
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.shortage import Shortage
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep, crossing_of
from flexspline.pipeline.diagnosis.sweep.race.torque_offset_race import is_shifted
from flexspline.pipeline.diagnosis.sweep.verdict import JudgedSweep

USUAL_SCATTER = 0.4
"""Of the median size: by so much units of one batch may differ, friction foremost, and are told together."""
MOST_UNITS = 12
"""Most units that are each judged by itself. A unit takes about a second."""


@dataclass(frozen=True)
class UnitsApart:
    """Each unit's own verdict.

    Attributes
    ----------
    decisions : of each unit that was asked, by its name; None of one with too few rows.
    unit, shown : name and explanation of the one that is read late; else of one whose verdict is open; else
        of the one whose causes are largest.
    decision : on all of them.
    """

    decisions: Mapping[str, Decision | None]
    unit: str
    shown: JudgedSweep
    decision: Decision


def units_apart(
    whole: JudgedSweep, judge: Callable[[Sweep, Prediction], JudgedSweep | Shortage]
) -> UnitsApart | None:
    """The units' own verdicts, where units differ and each by itself is explained.

    `judge` is asked about the rows of one unit. A unit whose reading comes late is the answer, and no other
    is asked. None where one of them is not explained; where all rows together show the same as each unit, in
    about the same size; and where one is stiffer than the others: that may as well be the gain of its own
    reading.
    """
    names = whole.sweep.units
    if whole.misread is not None or not 2 <= len(names) <= MOST_UNITS:
        return None
    known = whole.decision.verdict != "unknown"
    differ = _differing(whole.explained) if known else set()
    if known and not differ:
        return None
    decisions: dict[str, Decision | None] = {}
    largest, unit, shown = (False, 0.0), "", whole
    for number, name in enumerate(names):
        alone = judge(of_units(whole.sweep, [number]), whole.explained.prepared.prediction)
        if not isinstance(alone, JudgedSweep):
            decisions[name] = None
            continue
        own = alone.decision
        decisions[name] = own
        if (
            alone.misread is not None
        ):  # what all rows make of one unit's late reading is none of their causes
            return UnitsApart(decisions, name, alone, own)
        if own.verdict == "unknown":
            return None
        size = own.verdict == "ambiguous", hypot(*(c.rms_arcsec for c in own.causes))
        if size > largest:
            largest, unit, shown = size, name, alone
    judged = {name: own for name, own in decisions.items() if own is not None}
    causes = _of_all(judged)
    series = [c for c in causes if c.id == SERIES]
    if len(judged) < 2 or not causes or len(series) > 1 or any(c.own_units for c in series):
        return None
    if known and not whole.decision.unexplained:
        together = {c.id for c in whole.decision.causes}
        each_shows = all({c.id for c in own.causes} == together for own in judged.values())
        if each_shows and len(causes) == len(together):
            return None
        rivals = {other for c in whole.decision.causes for other in c.alternatives}
        # which fewer rows may find by chance
        if {c.id for c in causes} - together - rivals - differ:
            return None
    left = tuple(u for own in judged.values() for u in own.unexplained)
    decision = Decision("ambiguous" if largest[0] else "named", causes, left)
    return UnitsApart(decisions, unit, shown, decision)


def _differing(explained: ExplainedSweep) -> set[str]:
    """Causes that differ between units, and a gap of one unit that is far from the simulated one or crossed
    elsewhere."""
    prepared, fit = explained.prepared, explained.identified.fit
    differing = {cause for cause, shares in explained.shares.items() if shares.differ}
    if any(fit.calibration_of(u).far_off(prepared.prediction) for u in range(fit.units)):
        differing.add(CLEARANCE)
    own = [rows[~prepared.outlier[rows]] for rows in prepared.rig.history.unit_slices]
    crossings = [crossing_of(prepared, fit, rows) for rows in own]
    if any(seen is not None and is_shifted(seen, prepared) for seen in crossings):
        differing.add(OFFSET)
    return differing


def _of_all(judged: Mapping[str, Decision]) -> tuple[NamedCause, ...]:
    """The causes of all units, the largest first: of about one size once, and each that stands out."""
    of_cause: dict[str, dict[str, NamedCause]] = {}
    for name, own in judged.items():
        for c in own.causes:
            of_cause.setdefault(c.id, {})[name] = c
    named = [c for units in of_cause.values() for c in _by_size(units, len(judged))]
    return tuple(sorted(named, key=lambda c: -c.rms_arcsec))


def _by_size(units: Mapping[str, NamedCause], count: int) -> Iterator[NamedCause]:
    """One cause by units: those of about one size together, and every other; of `count` units in all."""
    effect = {name: c.magnitude - none_of(c) for name, c in units.items()}
    usual = float(np.median([*effect.values()]))
    apart = {
        name: c
        for name, c in units.items()
        if abs(effect[name] - usual) > max(SIZE_KNOWN * c.magnitude_std, USUAL_SCATTER * abs(usual))
    }
    rest = {name: c for name, c in units.items() if name not in apart}
    if rest:
        own = tuple(rest) if len(rest) < count else ()
        yield replace(_mean([*rest.values()]), own_units=own)
    for name, c in apart.items():
        yield replace(c, own_units=(name,))


def _mean(causes: Sequence[NamedCause]) -> NamedCause:
    """One cause of several units; its deviation holds how they scatter."""
    largest = max(causes, key=lambda c: c.rms_arcsec)
    if len(causes) == 1:
        return largest
    size = np.array([c.magnitude for c in causes])
    own = float(np.mean([c.magnitude_std**2 for c in causes]))
    rivals = dict.fromkeys(rival for c in causes for rival in c.alternatives)
    return replace(
        largest,
        probability=min(c.probability for c in causes),
        alternatives=tuple(rivals),
        magnitude=float(size.mean()),
        magnitude_std=sqrt((own + float(size.var(ddof=1))) / len(causes)),
        rms_arcsec=sqrt(float(np.mean([c.rms_arcsec**2 for c in causes]))),
    )


def of_units(sweep: Sweep, units: Sequence[int]) -> Sweep:
    """The rows of some units, as a record of its own."""
    chosen = np.isin(sweep.history.unit, units)
    history = sweep.history.rows(chosen)
    went_to = np.arange(len(sweep)) if sweep.went_to is None else sweep.went_to
    here = (went_to >= 0) & chosen[went_to]
    return replace(
        sweep,
        history=replace(history, unit=np.searchsorted(np.sort(units), history.unit)),
        angle_arcsec=sweep.angle_arcsec[chosen],
        units=tuple(sweep.units[u] for u in sorted(units)),
        cycles=tuple(sweep.cycles[u] for u in sorted(units)),
        line=sweep.line[chosen],
        went_to=np.where(here, (np.cumsum(chosen) - 1)[went_to], -1),
    )
