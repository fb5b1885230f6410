"""End points and a prediction in, a verdict out: the steps in order.

| step | file |
|---|---|
| deviations of all units from the prediction | `unit_findings.py` |
| the envelope at each torque; each unit against it | `envelope.py`, `unit_findings.py` |
| evidence of a set of causes | `regressors.py`, `evidence.py` |
| race: causes of all units, or of one | `race.py` |
| verdict, causes and rivals | `decide.py`, rules in `../decision.py` |
| what would distinguish the rivals | `models.py`, `next_measurement.py`, `../plans.py` |
| calibration, error on units left out, the model | `models.py` |

Rules, with their numbers:
- No unit beyond the envelope (`finding.CORRECTED_P_VALUE`), and no hypothesis OVER_SIMULATION_NATS better
  than the simulation within its uncertainty: `consistent`.
- Otherwise the likeliest cause is listed with every rival within the limits of docs/contract.md: 4 nats of
  evidence or 6 of penalised likelihood. Any rival left, or evidence below OVER_SIMULATION_NATS: `ambiguous`;
  none: `named`.
- A curve of no cause that is the likeliest: `unknown`, in channel `torque_Nm`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.geometry.design import Design
from flexspline.pipeline.diagnosis.decision import CONSISTENT
from flexspline.pipeline.diagnosis.end_points.decide import OVER_SIMULATION_NATS, decide
from flexspline.pipeline.diagnosis.end_points.envelope import envelope
from flexspline.pipeline.diagnosis.end_points.evidence import UnitDeviations, unit_evidence
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis
from flexspline.pipeline.diagnosis.end_points.models import (
    calibration_of,
    extended,
    gain_of,
    rivals_for_unit,
)
from flexspline.pipeline.diagnosis.end_points.next_measurement import next_measurement, separated
from flexspline.pipeline.diagnosis.end_points.race import SUSPECTS, race, several_torques
from flexspline.pipeline.diagnosis.end_points.regressors import rig_of
from flexspline.pipeline.diagnosis.end_points.unit_findings import (
    mid_positions,
    unit_deviations,
    unit_findings,
)
from flexspline.pipeline.diagnosis.measurement.record import EndPoints
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.plans import PlanSeparation
from flexspline.pipeline.diagnosis.prediction import Prediction

MOST_RACE_ROWS = 1000
"""Most rows of the race. Every unit is compared with the envelope, but this many rows are enough to find what
the units share. Judgement."""


def diagnose_end_points(
    design: Design, points: EndPoints, prediction: Prediction
) -> tuple[DiagnosisOutcome, EndPointAnalysis, ExtendedModel | None]:
    """The verdict, what stands behind it, and the model where there is one."""
    deviations, names = unit_deviations(points, prediction)
    rig = rig_of(points, prediction)
    envelopes = tuple(
        envelope(design, prediction, float(t), deviations.readings[0])
        for t in np.unique(points.torque_Nm)
    )
    null = unit_evidence(deviations, ())
    units = unit_findings(points, deviations, names, envelopes)
    furthest = sorted(range(len(units)), key=lambda u: units[u].p_value)
    rows = _raced_rows(points, deviations, names, furthest)
    some = points.rows(rows)
    racing, raced = unit_deviations(some, prediction)
    suspects = [raced.index(names[u]) for u in furthest[:SUSPECTS]]
    hypotheses = race(some, rig, racing, suspects)
    best = next(h for h in hypotheses if h.causes)
    decision = CONSISTENT
    plans: tuple[PlanSeparation, ...] = ()
    if best.score > OVER_SIMULATION_NATS or not all(u.within for u in units):
        beyond = [u for u in units if not u.within]
        if best.score <= OVER_SIMULATION_NATS and len(beyond) == 1 and len(names) > 1:
            # one unit is what is to be explained, even where another cause fits all units a little better
            alone = raced.index(beyond[0].unit)
            hypotheses = [h for h in hypotheses if not h.causes or h.own == alone]
        decision = decide(hypotheses, rig, raced, prediction)
    worst = units[furthest[0]]
    if decision.verdict == "ambiguous":
        first = decision.causes[0]
        rivals = rivals_for_unit(points, rig, prediction, worst, (first.id, *first.alternatives))
        if rivals:  # none of a cause that moves mid positions alone
            plans = separated(worst.torque_Nm, rivals, prediction, null.reading)
    named = decision.verdict == "named"
    kept = best.best if named else null
    analysis = EndPointAnalysis(
        envelopes, units, mid_positions(deviations, prediction), null.common, null.share, kept.reading,
        tuple(hypotheses), plans, several_torques(deviations), calibration_of(kept, prediction),
        len(rows),
    )  # fmt: skip
    outcome = DiagnosisOutcome(
        decision.verdict, decision.causes, decision.unexplained,
        gain_of(racing, best, raced, rows) if named else None,
        next_measurement(decision, plans, worst),
    )  # fmt: skip
    model = None
    if named:
        model = extended(kept, racing, raced, prediction)
    elif decision.verdict == "consistent":
        model = extended(null, deviations, names, prediction)
    return outcome, analysis, model


def _raced_rows(
    points: EndPoints, deviations: UnitDeviations, names: Sequence[str], furthest: Sequence[int]
) -> np.ndarray:
    """All rows, or, of a very large file, those of evenly chosen units and of the suspects; by indices."""
    if len(points.unit) <= MOST_RACE_ROWS:
        return np.arange(len(points.unit))
    step = -(-len(points.unit) // MOST_RACE_ROWS)
    chosen = set(range(0, len(names), step)) | set(furthest[:SUSPECTS])
    return np.sort(np.concatenate([r for u, r in enumerate(deviations.unit_rows) if u in chosen]))
