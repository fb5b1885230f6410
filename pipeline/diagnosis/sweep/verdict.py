"""The verdict on a sweep, what it leaves unexplained, what to measure next, and all that in words."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, hypot, log10

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import (
    NamedCause,
    NextMeasurement,
    Unexplained,
    Verdict,
    left_out,
)
from flexspline.pipeline.diagnosis.sweep.fit import fit_regressors
from flexspline.pipeline.diagnosis.sweep.named_causes import model_of
from flexspline.pipeline.diagnosis.sweep.next_measurement import to_tell_apart
from flexspline.pipeline.diagnosis.sweep.offset_race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.residual_tests import SIGNIFICANT, ChannelTest
from flexspline.pipeline.diagnosis.sweep.search import Candidate

UNEXPLAINED_SHARE = 0.5
"""Of the named effects' rms: with more left unexplained the verdict is `unknown`."""
SURE = 1e-8
"""p-value of a channel's structure that, with nothing named, makes the verdict `unknown`."""
COMPETITOR_P = 1e-6
"""Said of a competitor in the best set: it had to gain more than this over chance to get there."""


def verdict_of(
    explained: ExplainedSweep, found: Sequence[NamedCause], tests: Sequence[ChannelTest]
) -> Verdict:
    """The contract's word for what was found."""
    decision = explained.decision
    named = hypot(*(c.rms_arcsec for c in found)) if found else 0.0
    if decision.unnamed_rms > UNEXPLAINED_SHARE * named:
        return "unknown"
    if not found:
        sure = any(t.p_value < SURE for t in tests)
        return "unknown" if sure else "consistent"
    return "ambiguous" if any(c.alternatives for c in found) else "named"


def unexplained_of(
    explained: ExplainedSweep, tests: Sequence[ChannelTest]
) -> tuple[Unexplained, ...]:
    """Competitors and minor causes of the best set, and channels in which the rest is significant."""
    decision = explained.decision
    found = []
    for owner, rms in sorted(decision.rms.items(), key=lambda item: -item[1]):
        if not owner.startswith("?"):
            if owner not in decision.named:
                found.append(
                    Unexplained(
                        "torque_Nm",
                        rms,
                        COMPETITOR_P,
                        f"a trace like {known_causes()[owner].title}",
                    )
                )
            continue
        what = {
            decision.search.evidence.terms[i].what
            for i in decision.best.terms
            if decision.search.evidence.terms[i].owner == owner
        }
        found.append(Unexplained(owner[1:], rms, COMPETITOR_P, "; ".join(sorted(what))))
    said = {u.channel for u in found}
    for t in sorted(tests, key=lambda t: t.p_value):
        if t.p_value < SIGNIFICANT and t.channel not in said:
            found.append(
                Unexplained(t.channel, t.rms_arcsec, t.p_value, "what the best model leaves")
            )
    return tuple(found)


def next_of(
    explained: ExplainedSweep,
    found: Sequence[NamedCause],
    verdict: str,
    unexplained: Sequence[Unexplained],
) -> NextMeasurement | None:
    """What to measure next: to find the unknown, to part rivals, or to confirm the smallest cause."""
    if verdict == "unknown" and unexplained:
        worst = unexplained[0]
        return NextMeasurement(
            worst.channel,
            f"the structure lies in {worst.channel} ({worst.what}): vary it alone, everything else held", 0.0,
        )  # fmt: skip
    unsure = [c for c in found if c.alternatives] or list(found[-1:])
    if not unsure:
        return None
    cause = unsure[0]
    decision = explained.decision
    sweep = explained.prepared.sweep
    rivals = cause.alternatives
    models = [model_of(decision.fit, sweep, [c.id for c in found], explained.offset_Nm)]
    rival = decision.rival_sets.get(cause.id)
    if rival is not None and rivals:
        models.append(_rival_model(explained, rival))
    if not rivals:
        vary = known_causes()[cause.id].vary
        return NextMeasurement(
            vary, f"to confirm {cause.title}: {known_causes()[cause.id].reveals}", 0.0
        )
    return to_tell_apart(explained.prepared, models, cause.id, rivals)


def _rival_model(explained: ExplainedSweep, rival: Candidate) -> ExtendedModel:
    fit = fit_regressors(explained.decision.search.evidence, rival.terms)
    return model_of(fit, explained.prepared.sweep, sorted(fit.elements()), explained.offset_Nm)


def summary_of(
    verdict: str, found: Sequence[NamedCause], unexplained: Sequence[Unexplained]
) -> str:
    """One or two sentences in plain words."""
    listed = "; ".join(map(_said, found))
    where = ", ".join(dict.fromkeys(u.channel for u in unexplained))
    match verdict:
        case "consistent":
            return "The measurement agrees with the simulation within its stated uncertainty and the noise."
        case "named":
            return left_out(found, _said)
        case "ambiguous":
            titles = known_causes()
            rivals = "; ".join(
                f"{c.title} cannot be told from {' or '.join(titles[r].title for r in c.alternatives)}"
                for c in found if c.alternatives
            )  # fmt: skip
            return f"Something is missing from the simulation, and these data cannot tell what: {rivals}."
        case _:
            known = f" Beside it: {listed}." if found else ""
            return (
                f"There is structure in {where or 'the data'} that no known cause explains.{known}"
            )


def _said(cause: NamedCause) -> str:
    unit = "" if cause.unit == "1" else f" {cause.unit}"
    where = f" (only {', '.join(cause.own_units)})" if cause.own_units else ""
    return f"{cause.title}, {_figures(cause.magnitude, cause.magnitude_std)}{unit}{where}"


def _figures(value: float, std: float) -> str:
    """A value to the second digit of its deviation."""
    places = max(0, 1 - floor(log10(std))) if std > 0 else 3
    return f"{value:.{places}f} ± {std:.{places}f}".replace("-", "−")


def _fleet_notes(explained: ExplainedSweep) -> list[str]:
    """What the units have in common, and how they differ."""
    names = explained.prepared.sweep.units
    notes = []
    for cause, shares in explained.shares.items():
        title = known_causes()[cause].title
        if not shares.differ:
            notes.append(f"{title}: common to all {len(names)} units")
            continue
        each = ", ".join(
            f"{n} {s:.2f} ± {d:.2f}"
            for n, s, d in zip(names, shares.share, shares.share_std, strict=True)
        )
        notes.append(f"{title}: differs between units; shares of the common effect: {each}")
    return notes


def notes_of(explained: ExplainedSweep) -> tuple[str, ...]:
    """What a reader should know of how the record was used."""
    prepared = explained.prepared
    notes = []
    dropped = int(prepared.outlier.sum())
    if dropped:
        notes.append(f"{dropped} isolated outliers were left out")
    notes.append(
        f"rows with |T| < {prepared.band_Nm:.3g} N·m (backlash crossing) were not used for identification"
    )
    if prepared.sweep.history.time_s is None:
        notes.append("no time was recorded: friction cannot be told from rate dependence")
    notes += _fleet_notes(explained)
    if prepared.sweep.ignored:
        notes.append(f"columns not used: {', '.join(prepared.sweep.ignored)}")
    return tuple(notes)
