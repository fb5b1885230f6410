"""The race of hypotheses: which causes, of all units or of one, explain the end points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from math import log

import numpy as np
from scipy.special import logsumexp

from flexspline.pipeline.diagnosis.causes.cause import Element, FitContext
from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING, StiffnessHardening
from flexspline.pipeline.diagnosis.end_points.evidence import (
    UnitDeviations,
    UnitEvidence,
    unit_evidence,
)
from flexspline.pipeline.diagnosis.end_points.regressors import (
    EndPointRegressor,
    end_point_regressors,
)
from flexspline.pipeline.diagnosis.measurement.record import EndPoints

SUSPECTS = 5
"""Units furthest from the prediction, each of which is tried for a cause of its own. Judgement."""
CAUSE_PAIR_NATS = -2.0
"""Log prior odds of two causes against one, 1 to 7."""
UNNAMED_CURVE_NATS = -2.0
"""Log prior odds of a curve without a name against a cause, 1 to 7: at equal evidence a cause is named."""
UNNAMED_CURVE_SPREAD = StiffnessHardening.spread_share
"""Prior standard deviation of that curve, of the predicted angle: as wide as soft wind-up's."""
UNNAMED = "?torque_Nm"
SIMULATION_SCORE = 0.0
"""Nats of the hypothesis without a cause, from which all others count."""
CONCAVE = {CLEARANCE, FRICTION, HARDENING}
"""All of these rise steeply with torque and level off. With two at once, end points would fit the second to
the shape of the first, so a pair has at most one of them."""
FREE_SPREAD_RATIO = 100.0
"""Factor on the prior's width. It then has a 10 000th of its weight, so the likelihood determines the
amplitude. 30 or 300 change nothing of 84 made-up sets (`evidence.CORRELATIONS`)."""


@dataclass(frozen=True)
class Hypothesis:
    """Some causes, of all units (`own` is None) or of one, with all their shapes.

    `score` is log evidence and log prior together; `penalised` the largest log likelihood less
    ½ log n for each amplitude; `best` its likeliest shapes.
    """

    causes: tuple[str, ...]
    own: int | None
    score: float
    penalised: float
    best: UnitEvidence


def race(
    points: EndPoints, rig: FitContext, deviations: UnitDeviations, suspects: Sequence[int]
) -> list[Hypothesis]:
    """All hypotheses, the likeliest first; the null has no causes and `SIMULATION_SCORE`."""
    terms = end_point_regressors(points, rig)
    several = several_torques(deviations)
    if not several:  # a zero per unit absorbs what shifts mid positions, and a curve needs torques
        terms = [t for t in terms if t.channel == "total"]
    else:
        curve = (deviations.torque / rig.largest_Nm) ** 2
        terms.append(
            EndPointRegressor(
                UNNAMED,
                "total",
                curve,
                UNNAMED_CURVE_SPREAD * rig.scale_arcsec,
                False,
                Element({}, (1.0,)),
            )
        )
    ids = list(dict.fromkeys(t.cause for t in terms))
    null = unit_evidence(deviations, ())
    hypotheses = [Hypothesis((), None, SIMULATION_SCORE, null.likelihood, null)]
    for cause in ids:
        mine = [t for t in terms if t.cause == cause]
        odds = (UNNAMED_CURVE_NATS if cause == UNNAMED else 0.0) - log(len(ids))
        hypotheses.append(_of(deviations, [(t,) for t in mine], None, odds, null))
        for u in suspects if deviations.units > 1 and cause != UNNAMED else ():
            rows = deviations.unit == u
            one = [(t.of(rows),) for t in mine]
            hypotheses.append(_of(deviations, one, u, odds - log(deviations.units), null))
    for a, b in combinations(ids, 2) if several else ():
        if {a, b} <= CONCAVE:
            continue
        pairs = [(s, t) for s in terms if s.cause == a for t in terms if t.cause == b]
        odds = (
            CAUSE_PAIR_NATS
            - log(len(ids) ** 2 / 2)
            + (UNNAMED_CURVE_NATS if UNNAMED in (a, b) else 0.0)
        )
        hypotheses.append(_of(deviations, pairs, None, odds, null))
    return sorted(hypotheses, key=lambda h: -h.score)


def several_torques(deviations: UnitDeviations) -> bool:
    """Whether some unit was measured at more than one torque."""
    return any(np.ptp(deviations.torque[rows]) > 0 for rows in deviations.unit_rows)


def _of(
    deviations: UnitDeviations,
    sets: Sequence[tuple[EndPointRegressor, ...]],
    own: int | None,
    odds: float,
    null: UnitEvidence,
) -> Hypothesis:
    each = [unit_evidence(deviations, terms) for terms in sets]
    scores = [e.evidence for e in each]
    best = each[int(np.argmax(scores))]
    score = float(logsumexp(scores)) - log(len(scores)) - null.evidence + odds
    free = unit_evidence(
        deviations, [replace(t, spread=FREE_SPREAD_RATIO * t.spread) for t in best.terms]
    )
    allowed = all(not t.positive or m > 0 for t, m in zip(best.terms, free.mean, strict=True))
    penalty = len(best.terms) * log(max(len(deviations.deviation), 2)) / 2
    return Hypothesis(
        tuple(t.cause for t in best.terms), own, score,
        free.likelihood - penalty if allowed else -np.inf, best,
    )  # fmt: skip
