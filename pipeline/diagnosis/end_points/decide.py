"""From hypotheses about end points to causes, rivals and unexplained structure."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.decision import (
    RIVAL_EVIDENCE,
    Decision,
    chance,
    decided,
    held_against,
    is_significant,
)
from flexspline.pipeline.diagnosis.end_points.evidence import UnitEvidence
from flexspline.pipeline.diagnosis.end_points.race import SIMULATION_SCORE, UNNAMED, Hypothesis
from flexspline.pipeline.diagnosis.outcome import NamedCause, Unexplained
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.structure import UnnamedForm

OVER_SIMULATION_NATS = RIVAL_EVIDENCE
"""Over the simulation within its uncertainty, which is a rival too."""


def decide(
    hypotheses: Sequence[Hypothesis], rig: FitContext, names: Sequence[str], prediction: Prediction
) -> Decision:
    """The decision on hypotheses of which some beats the simulation, or some unit is beyond the envelope."""
    best = next(h for h in hypotheses if h.causes)
    if UNNAMED in best.causes and best.score > OVER_SIMULATION_NATS:
        left = _unnamed(best, hypotheses)
        return decided((), (left,), named_rms=0.0, unnamed_rms=left.rms)
    best = next(h for h in hypotheses if h.causes and UNNAMED not in h.causes)

    def may_replace(h: Hypothesis) -> bool:
        return (
            UNNAMED not in h.causes
            and len(h.causes) <= len(best.causes)
            and _channels(h) == _channels(best)
        )

    causes_of_units = []
    for i, held in enumerate(held_against(best, hypotheses, SIMULATION_SCORE, may_replace)):
        magnitude, std = _magnitude(best.best, i, rig, prediction)
        term = best.best.terms[i]
        causes_of_units.append(
            NamedCause(
                held.cause,
                probability=held.probability,
                alternatives=tuple(held.alternatives),
                magnitude=magnitude,
                magnitude_std=std,
                unit=known_causes()[held.cause].unit,
                evidence_nats=held.evidence_nats,
                rms_arcsec=rms((term.column * best.best.mean[i])[term.column != 0]),
                own_units=() if best.own is None else (names[best.own],),
            )
        )
    sure = best.score > OVER_SIMULATION_NATS and all(map(is_significant, causes_of_units))
    return decided(
        causes_of_units,
        (),
        named_rms=hypot(*(c.rms_arcsec for c in causes_of_units)),
        unnamed_rms=0.0,
        sure=sure,
    )


def _unnamed(best: Hypothesis, hypotheses: Sequence[Hypothesis]) -> Unexplained:
    """The curve of no cause that is likeliest."""
    term, amplitude = best.best.terms[-1], best.best.mean[-1]
    p = chance(best.score, (h.score for h in hypotheses if UNNAMED not in h.causes))
    form = UnnamedForm("curve_of_totals")
    return Unexplained("torque_Nm", rms(term.column * amplitude), p, (form,))


def _channels(h: Hypothesis) -> set[str]:
    """Whether totals or mid positions are explained: what moves one cannot stand for the other."""
    return {t.channel for t in h.best.terms}


def _magnitude(
    best: UnitEvidence, i: int, rig: FitContext, prediction: Prediction
) -> tuple[float, float]:
    """The magnitude (docs/contract.md) and its standard deviation, to first order in the amplitude."""
    term, mean, std = best.terms[i], float(best.mean[i]), float(best.std[i])
    if term.cause == CLEARANCE:
        return mean + best.common[0], std
    if term.cause == SERIES:
        return 100 * mean / prediction.compliance, 100 * std / prediction.compliance
    cause = known_causes()[term.cause]
    low, here, high = (
        cause.magnitude(term.elements(a), rig) for a in (mean - std / 2, mean, mean + std / 2)
    )
    return here, abs(high - low)
