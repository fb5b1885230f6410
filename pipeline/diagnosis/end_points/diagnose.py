"""End points and a prediction in, an honest verdict out.

Rules, with their numbers:
- No unit beyond the envelope (`finding.SIGNIFICANT`), and no hypothesis NAMING_NATS better than the
  simulation within its uncertainty: `consistent`.
- Otherwise the likeliest cause is listed with every rival within the contract's limits: 4 nats of
  evidence or 6 of penalised likelihood. Any rival left, or evidence below NAMING_NATS: `ambiguous`;
  none: `named`.
- A curve of no cause that is the likeliest: `unknown`, in channel `torque_Nm`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.geometry.design import Design
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Rig
from flexspline.pipeline.diagnosis.end_points.envelope import Envelope, envelope
from flexspline.pipeline.diagnosis.end_points.finding import (
    EndPointAnalysis,
    MidPositions,
    UnitFinding,
)
from flexspline.pipeline.diagnosis.end_points.models import extended, gain_of, rivals_for_unit
from flexspline.pipeline.diagnosis.end_points.next_measurement import PlanSeparation, separations
from flexspline.pipeline.diagnosis.end_points.race import (
    SUSPECTS,
    UNNAMED,
    Hypothesis,
    race,
    several_torques,
)
from flexspline.pipeline.diagnosis.end_points.regressors import rig_of
from flexspline.pipeline.diagnosis.end_points.say import notes_of, summary_of
from flexspline.pipeline.diagnosis.end_points.unit_likelihood import (
    UnitDeviations,
    UnitEvidence,
    readings,
    unit_evidence,
)
from flexspline.pipeline.diagnosis.measurement.record import EndPoints
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import (
    DiagnosisOutcome,
    NamedCause,
    NextMeasurement,
    Unexplained,
    Verdict,
)
from flexspline.pipeline.diagnosis.prediction import Prediction

NAMING_NATS = 4.0
"""The simulation within its uncertainty is a rival too, by the contract's limit of evidence."""
RIVAL_EVIDENCE, RIVAL_LIKELIHOOD = 4.0, 6.0
MOST_ROWS = 1000
"""Of the race: every unit is held against the envelope, but so many tell what all share."""
RESOLUTIONS = (10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01)
"""Steps of an angle reading that a file may show [arcsec]."""


def diagnose_end_points(
    design: Design, points: EndPoints, prediction: Prediction
) -> tuple[DiagnosisOutcome, EndPointAnalysis, ExtendedModel | None]:
    """The verdict, what stands behind it, and the model where there is one."""
    fleet, names = fleet_of(points, prediction)
    rig = rig_of(points, prediction)
    envelopes = tuple(
        envelope(design, prediction.compliance, prediction.gap_arcsec, float(t), fleet.readings[0])
        for t in np.unique(points.torque_Nm)
    )
    null = unit_evidence(fleet, ())
    units = _units(points, fleet, names, envelopes, null)
    furthest = sorted(range(len(units)), key=lambda u: units[u].p_value)
    some = _some(points, fleet, names, furthest)
    racing, raced = (fleet, names) if some is points else fleet_of(some, prediction)
    suspects = [raced.index(names[u]) for u in furthest[:SUSPECTS]]
    hypotheses = race(some, rig, racing, suspects)
    best = next(h for h in hypotheses if h.causes)
    several = several_torques(fleet)
    verdict: Verdict = "consistent"
    found: tuple[NamedCause, ...] = ()
    unexplained: tuple[Unexplained, ...] = ()
    plans: tuple[PlanSeparation, ...] = ()
    if best.score > NAMING_NATS or not all(u.within for u in units):
        beyond = [u for u in units if not u.within]
        if best.score <= NAMING_NATS and len(beyond) == 1 and len(names) > 1:
            # one unit is what is to be explained, whatever suits the fleet a little better
            alone = raced.index(beyond[0].unit)
            hypotheses = [h for h in hypotheses if not h.causes or h.own == alone]
        verdict, found, unexplained = _decided(hypotheses, rig, raced, prediction)
    if verdict == "ambiguous":
        worst = units[furthest[0]]
        rivals = rivals_for_unit(
            points, rig, prediction, worst, (found[0].id, *found[0].alternatives)
        )
        plans = tuple(separations(worst.torque_Nm, rivals, prediction, null.reading))
    kept = best.best if verdict == "named" else null
    analysis = EndPointAnalysis(
        envelopes, units, _mids(fleet, prediction), null.common, null.share, kept.reading,
        tuple(hypotheses), plans,
    )  # fmt: skip
    outcome = DiagnosisOutcome(
        verdict, found, unexplained,
        gain_of(racing, best, raced) if verdict == "named" else None,
        _next(verdict, plans, units[furthest[0]], found),
        summary_of(verdict, found, analysis, several),
        notes_of(analysis, several),
    )  # fmt: skip
    model = None
    if verdict == "named":
        model = extended(kept, racing, raced, prediction)
    elif verdict == "consistent":
        model = extended(null, fleet, names, prediction)
    return outcome, analysis, model


def _some(
    points: EndPoints, fleet: UnitDeviations, names: Sequence[str], furthest: Sequence[int]
) -> EndPoints:
    """All rows, or, of a very large file, those of evenly chosen units and of the suspects."""
    if len(points.unit) <= MOST_ROWS:
        return points
    step = -(-len(points.unit) // MOST_ROWS)
    chosen = set(range(0, len(names), step)) | set(furthest[:SUSPECTS])
    rows = np.sort(np.concatenate([r for u, r in enumerate(fleet.unit_rows) if u in chosen]))
    return EndPoints(
        points.path, tuple(points.unit[i] for i in rows), points.torque_Nm[rows],
        points.angle_plus_arcsec[rows], points.angle_minus_arcsec[rows],
    )  # fmt: skip


def fleet_of(points: EndPoints, prediction: Prediction) -> tuple[UnitDeviations, tuple[str, ...]]:
    """Deviations of all rows, and the units' names in their order."""
    names = tuple(dict.fromkeys(points.unit))
    code = {name: i for i, name in enumerate(names)}
    total = points.angle_plus_arcsec - points.angle_minus_arcsec
    angles = np.concatenate([points.angle_plus_arcsec, points.angle_minus_arcsec])
    fleet = UnitDeviations(
        total - 2 * points.torque_Nm * prediction.compliance - prediction.gap_arcsec,
        (points.angle_plus_arcsec + points.angle_minus_arcsec) / 2,
        points.torque_Nm,
        np.array([code[u] for u in points.unit]),
        prediction.compliance_std,
        prediction.gap_std_arcsec,
        readings(_resolution(angles), total),
    )
    return fleet, names


def _resolution(angles: np.ndarray) -> float:
    """The coarsest step of which all angles are multiples; 0 where none is."""
    for step in RESOLUTIONS:
        if np.abs(angles / step - np.round(angles / step)).max() < 1e-6:
            return step
    return 0.0


def _units(
    points: EndPoints,
    fleet: UnitDeviations,
    names: Sequence[str],
    envelopes: Sequence[Envelope],
    null: UnitEvidence,
) -> tuple[UnitFinding, ...]:
    at = {e.torque_Nm: e for e in envelopes}
    looked = len(names) * min(2, len(envelopes))  # further torques of a unit share its clearance
    total = points.angle_plus_arcsec - points.angle_minus_arcsec
    found = []
    for u, (name, rows) in enumerate(zip(names, fleet.unit_rows, strict=True)):
        p_values = [at[float(points.torque_Nm[i])].p_value(float(total[i])) for i in rows]
        i, p = rows[int(np.argmin(p_values))], min(p_values)
        of = at[float(points.torque_Nm[i])]
        off = float(total[i]) - of.total_arcsec
        z = (
            off / of.std_arcsec
            if of.std_arcsec > 0
            else float(np.sign(off)) * np.inf
            if off
            else 0.0
        )
        found.append(UnitFinding(
            name, of.torque_Nm, float(total[i]), of.total_arcsec, of.std_arcsec, float(fleet.mid[i]),
            z, p, float(-np.expm1(looked * np.log1p(-min(p, 1 - 1e-15)))), float(null.own[u]),
            of.explanation(float(total[i])),
        ))  # fmt: skip
    return tuple(found)


def _mids(fleet: UnitDeviations, prediction: Prediction) -> MidPositions:
    each = [float(fleet.mid[rows].mean()) for rows in fleet.unit_rows]
    spread = float(np.std(each, ddof=1)) if len(each) > 1 else 0.0
    return MidPositions(tuple(each), spread, float(fleet.torque.max()) * prediction.compliance)


def _decided(
    hypotheses: Sequence[Hypothesis], rig: Rig, names: Sequence[str], prediction: Prediction
) -> tuple[Verdict, tuple[NamedCause, ...], tuple[Unexplained, ...]]:
    best = next(h for h in hypotheses if h.causes)
    if UNNAMED in best.causes and best.score > NAMING_NATS:
        term, amplitude = best.best.terms[-1], best.best.mean[-1]
        rms = float(np.sqrt(np.mean((term.column * amplitude) ** 2)))
        without = max(h.score for h in hypotheses if UNNAMED not in h.causes)
        p = float(np.exp(min(0.0, without - best.score)))
        return (
            "unknown",
            (),
            (Unexplained("torque_Nm", rms, p, "a curve of the totals over torque"),),
        )
    named = [h for h in hypotheses if h.causes and UNNAMED not in h.causes]
    best = named[0]
    weights = np.exp([h.score - max(0.0, best.score) for h in hypotheses])
    found = []
    for i, cause in enumerate(best.causes):
        kept = set(best.causes) - {cause}
        rivals = [
            h for h in named
            if cause not in h.causes and kept <= set(h.causes) and len(h.causes) <= len(best.causes)
            and _channels(h) == _channels(best)
            and (best.score - h.score < RIVAL_EVIDENCE or best.penalised - h.penalised < RIVAL_LIKELIHOOD)
        ]  # fmt: skip
        alternatives = dict.fromkeys(c for h in rivals for c in h.causes if c not in best.causes)
        having = sum(w for w, h in zip(weights, hypotheses, strict=True) if cause in h.causes)
        without = max(h.score for h in hypotheses if cause not in h.causes)
        magnitude, std = _magnitude(best.best, i, rig, prediction)
        term = best.best.terms[i]
        found.append(NamedCause(
            cause, known_causes()[cause].title_at(magnitude), float(having / weights.sum()),
            tuple(alternatives), magnitude, std, known_causes()[cause].unit, best.score - without,
            float(np.sqrt(np.mean((term.column * best.best.mean[i])[term.column != 0] ** 2))),
            () if best.own is None else (names[best.own],),
        ))  # fmt: skip
    found.sort(key=lambda c: -c.rms_arcsec)
    sure = best.score > NAMING_NATS and not any(c.alternatives for c in found)
    return "named" if sure else "ambiguous", tuple(found), ()


def _channels(h: Hypothesis) -> set[str]:
    """Whether totals or mid positions are explained: what moves one cannot stand for the other."""
    return {t.channel for t in h.best.terms}


def _magnitude(best: UnitEvidence, i: int, rig: Rig, prediction: Prediction) -> tuple[float, float]:
    """The contract's magnitude and its standard deviation, to first order in the amplitude."""
    term, mean, std = best.terms[i], float(best.mean[i]), float(best.std[i])
    if term.cause == "clearance_offset":
        return mean + best.common[0], std
    if term.cause == "series_compliance":
        return 100 * mean / prediction.compliance, 100 * std / prediction.compliance
    cause = known_causes()[term.cause]
    low, here, high = (
        cause.magnitude(term.elements(a), rig) for a in (mean - std / 2, mean, mean + std / 2)
    )
    return here, abs(high - low)


def _next(
    verdict: Verdict,
    plans: Sequence[PlanSeparation],
    worst: UnitFinding,
    found: Sequence[NamedCause],
) -> NextMeasurement | None:
    if verdict == "unknown":
        return NextMeasurement(
            "torque_Nm", "closed torque sweeps show the whole curve, not its ends", 0.0
        )
    if not plans or not found:
        return None
    best = plans[0]
    titles = [known_causes()[c].title for c in (found[0].id, *found[0].alternatives)]
    apart = (
        f"the two of them that are nearest to each other then differ by {best.separation:.0f} times the "
        "noise" if len(titles) > 1 else "it would confirm or clear the suspicion"
    )  # fmt: skip
    second = next((p for p in plans[1:] if p.vary == "torque_Nm"), None)
    less = (
        f" (end points at the same torques: {second.separation:.1f})"
        if second and len(titles) > 1
        else ""
    )
    return NextMeasurement(
        best.vary, f"on unit {worst.unit}: {best.doing}; it tells {', '.join(titles)} apart: {apart}{less}",
        best.separation,
    )  # fmt: skip
