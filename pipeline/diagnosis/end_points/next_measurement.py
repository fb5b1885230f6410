"""The measurement that would tell apart what end points cannot."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.decision import Decision
from flexspline.pipeline.diagnosis.end_points.finding import UnitFinding
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import Doing, NextMeasurement
from flexspline.pipeline.diagnosis.plans import MeasurementPlan, PlanSeparation, separations
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.rated_limit import within_rated

AMPLITUDES = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Times the torque measured, two octaves either way: a spring's twist then spans 16 to 1, a gap's none. Not
beyond rated torque."""
PLANNED_ROWS = 64
"""Rows of one loop [1]: sixteen between zero and an end draw its shape. The repeat has as many."""
TIMES_OVER = PLANNED_ROWS // 2
"""The same two end points, in as many rows."""
READING_ARCSEC = 1.0
"""[arcsec] Smallest standard deviation of a reading when plans are compared. Judgement."""


def plans(torque_Nm: float, rated_Nm: float | None = None) -> list[MeasurementPlan]:
    """What can be done with the same rig, within the rated torque that the design states."""
    listed = within_rated((a * torque_Nm for a in AMPLITUDES), torque_Nm, rated_Nm)
    ends = [s * end for end in listed for s in (1, -1)]
    quarter = np.arange(1, PLANNED_ROWS // 4 + 1) / (PLANNED_ROWS // 4)
    loop = np.concatenate([quarter, 1 - quarter, -quarter, quarter - 1])
    one = np.concatenate([loop, loop])
    return [
        MeasurementPlan(
            "repeat",
            Doing("same_ends"),
            History.course(np.tile([torque_Nm, -torque_Nm], TIMES_OVER)),
        ),
        MeasurementPlan(
            "torque_Nm", Doing("other_ends", listed, rated_Nm), History.course(np.array(ends))
        ),
        MeasurementPlan(
            "sweep",
            Doing("closed_sweep", (torque_Nm,)),
            History.course(torque_Nm * one),
        ),
        MeasurementPlan(
            "torque_amplitude",
            Doing("closed_sweeps", listed, rated_Nm),
            History.course(np.concatenate([end * loop for end in listed])),
        ),
    ]


def separated(
    torque_Nm: float, models: Sequence[ExtendedModel], prediction: Prediction, noise_arcsec: float
) -> tuple[PlanSeparation, ...]:
    """Every plan by how far it drives the models apart, the widest first.

    A difference counts only beyond what a zero and a calibration of K and gap within the design's
    uncertainty would absorb.
    """
    calibration = (prediction.compliance_std, prediction.gap_std_arcsec)
    noise = max(noise_arcsec, READING_ARCSEC)
    return tuple(separations(plans(torque_Nm, prediction.rated_Nm), models, noise, calibration))


def next_measurement(
    decision: Decision, plans: Sequence[PlanSeparation], worst: UnitFinding
) -> NextMeasurement | None:
    """What to measure next: closed sweeps for the unknown, the widest plan on the worst unit for rivals."""
    if decision.verdict == "unknown":
        return NextMeasurement("torque_Nm", "find_structure")
    if decision.verdict != "ambiguous":
        return None
    first = decision.causes[0]
    if not plans:
        cause = known_causes()[first.id]
        return NextMeasurement(cause.vary, "confirm", (first.id,), unit=worst.unit)
    best = plans[0]
    same = next((p.separation for p in plans[1:] if p.vary == "torque_Nm"), None)
    return NextMeasurement(
        best.vary, "separate" if first.alternatives else "confirm", (first.id, *first.alternatives),
        best.doing, worst.unit, best.separation, same,
    )  # fmt: skip
