"""Units under test that no common explanation holds for: each is judged by its own rows.

One gear of three may drift, or have another position error. All rows together then show the mean of an effect
and of none, and what that misses in each unit has no name.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import hypot, sqrt

import numpy as np

from flexspline.pipeline.diagnosis.decision import Decision
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.sweep.fit import LINEAR
from flexspline.pipeline.diagnosis.sweep.judged import JudgedSweep, judge
from flexspline.pipeline.diagnosis.sweep.offset_race import is_shifted
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep, crossing_of


@dataclass(frozen=True)
class UnitsApart:
    """Each unit's own verdict.

    Attributes
    ----------
    judged : of each unit, by its name. shown : the name of the one whose causes are largest.
    decision : on all of them.
    """

    judged: Mapping[str, JudgedSweep]
    shown: str
    decision: Decision


def units_apart(whole: JudgedSweep) -> UnitsApart | None:
    """The units' own verdicts, where units differ and each by itself is explained.

    None where one of them is not, where all show the same causes, which all rows together tell best, and
    where one is stiffer or has another gap: that may as well be the gain of its own reading.
    """
    names = whole.sweep.units
    if len(names) < 2 or not (whole.decision.verdict == "unknown" or _differ(whole.explained)):
        return None
    judged: dict[str, JudgedSweep] = {}
    for number, name in enumerate(names):
        alone = judge(of_units(whole.sweep, [number]), whole.explained.prepared.prediction)
        if not isinstance(alone, JudgedSweep) or alone.decision.verdict == "unknown":
            return None
        judged[name] = alone
    shown = {name: {c.id for c in j.decision.causes} for name, j in judged.items()}
    alike = all(ids == shown[names[0]] for ids in shown.values())
    if not any(shown.values()) or (alike and whole.decision.verdict != "unknown"):
        return None
    if not alike and any(ids & {*LINEAR} for ids in shown.values()):
        return None
    largest = {
        name: hypot(*(c.rms_arcsec for c in j.decision.causes)) for name, j in judged.items()
    }
    open_ = any(j.decision.verdict == "ambiguous" for j in judged.values())
    left = tuple(u for j in judged.values() for u in j.decision.unexplained)
    decision = Decision("ambiguous" if open_ else "named", _of_all(judged), left)
    return UnitsApart(judged, max(largest, key=lambda name: largest[name]), decision)


def _differ(explained: ExplainedSweep) -> bool:
    """Whether a cause is not the same in all units, or the gap is crossed elsewhere in one of them."""
    if any(shares.differ for shares in explained.shares.values()):
        return True
    prepared = explained.prepared
    outlier, history = prepared.outlier, prepared.rig.history
    own = [rows[~outlier[rows]] for rows in history.unit_slices]
    crossings = [crossing_of(prepared, explained.identified.fit, rows) for rows in own]
    return any(seen is not None and is_shifted(seen, prepared) for seen in crossings)


def _of_all(judged: Mapping[str, JudgedSweep]) -> tuple[NamedCause, ...]:
    """The causes of all units, the largest first, each once: a mean over those that show it."""
    of_cause: dict[str, dict[str, NamedCause]] = {}
    for name, j in judged.items():
        for c in j.decision.causes:
            of_cause.setdefault(c.id, {})[name] = c
    found = []
    for units in of_cause.values():
        own = tuple(units) if len(units) < len(judged) else ()
        found.append(replace(_mean([*units.values()]), own_units=own))
    return tuple(sorted(found, key=lambda c: -c.rms_arcsec))


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
