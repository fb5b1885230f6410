"""Notes on a sweep of several units: common effects and differences."""

from __future__ import annotations

from flexspline.geometry.listed import listed
from flexspline.pipeline.diagnosis.decision import Decision
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.sweep.analysis import SweepAnalysis
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.separate_units import UnitsApart
from flexspline.results.diagnosis.structure_words import structure_words
from flexspline.results.diagnosis.words import cause_title, magnitude_words, title_of
from flexspline.results.numbers import signed

UNITS_APART_PCT = 1.0
"""Of their compliance, from which each unit's own is said: what clamps and bolts differ by."""


def unit_notes(analysis: SweepAnalysis) -> list[str]:
    """One line each; none for a single unit."""
    if analysis.apart is not None:
        return _apart_notes(analysis.apart)
    return [*_share_notes(analysis.explained), *_size_notes(analysis.model)]


def _apart_notes(separate: UnitsApart) -> list[str]:
    """What each unit shows by itself, and which one the figures are of."""
    notes = [
        "the units differ, so each was diagnosed separately; figures, calibrated values, errors on held-out "
        f"rows and the extended model are those of {separate.unit}"
    ]
    return notes + [
        f"{name} alone: {_decided(decision)}" for name, decision in separate.decisions.items()
    ]


def _decided(decision: Decision | None) -> str:
    if decision is None:
        return "too few rows for a verdict"
    if decision.verdict == "unknown":
        return structure_words(decision.unexplained[0])
    return "; ".join(map(_sized, decision.causes)) or "agrees with the simulation"


def _sized(cause: NamedCause) -> str:
    others = "".join(f", or {title_of(c)}" for c in cause.alternatives)
    return f"{cause_title(cause)}, {magnitude_words(cause)}{others}"


def _share_notes(explained: ExplainedSweep) -> list[str]:
    """What the units have in common, and how they differ."""
    names = explained.prepared.sweep.units
    notes = []
    for cause, shares in explained.shares.items():
        title = title_of(cause)
        if not shares.differ:
            notes.append(f"{title}: common to all {len(names)} units")
            continue
        shares_of_units = zip(names, shares.share, shares.share_std, strict=True)
        values = listed((f"{n} {s:.2f} ± {d:.2f}" for n, s, d in shares_of_units), "units")
        mean = "differs between units; the extended model uses the mean for all of them"
        notes.append(f"{title}: {mean}; shares of the mean: {values}")
    return notes


def _size_notes(model: ExtendedModel) -> list[str]:
    """Gap and compliance of each unit, where there are several: `calibrated` has what they have in common."""
    if len(model.own) < 2:
        return []
    gaps = {unit: model.gap_arcsec + gap for unit, (_, gap) in model.own.items()}
    values = listed((f"{unit or '?'} {gap:.1f} arcsec" for unit, gap in gaps.items()), "units")
    spread = max(gaps.values()) - min(gaps.values())
    notes = [f"gap of each unit: {values}; they are {spread:.1f} arcsec apart"]
    softer = {u: 100 * compliance / model.compliance for u, (compliance, _) in model.own.items()}
    if max(softer.values()) - min(softer.values()) > UNITS_APART_PCT:
        values = listed((f"{unit or '?'} {signed(s, 1)} %" for unit, s in softer.items()), "units")
        notes.append(f"difference of each unit's compliance from the common value: {values}")
    return notes
