"""Measured end points as deviations from the prediction, and each unit against the envelope."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.end_points.envelope import Envelope
from flexspline.pipeline.diagnosis.end_points.evidence import (
    UnitDeviations,
    readings,
)
from flexspline.pipeline.diagnosis.end_points.finding import MidPositions, UnitFinding
from flexspline.pipeline.diagnosis.measurement.record import EndPoints
from flexspline.pipeline.diagnosis.prediction import Prediction

RESOLUTIONS = (10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01)
"""Steps of an angle reading that a file may show [arcsec]: round steps of displays; finer count as none."""
LARGEST_P_VALUE = 1 - 1e-15
"""Largest probability p that is used: a few doubles below 1, so that the logarithm of 1 − p is finite."""


def unit_deviations(
    points: EndPoints, prediction: Prediction
) -> tuple[UnitDeviations, tuple[str, ...]]:
    """Deviations of all rows, and the units' names in their order."""
    names = tuple(dict.fromkeys(points.unit))
    code = {name: i for i, name in enumerate(names)}
    total = points.total_arcsec
    angles = np.concatenate([points.angle_plus_arcsec, points.angle_minus_arcsec])
    deviations = UnitDeviations(
        total - prediction.twist_arcsec(-points.torque_Nm, points.torque_Nm),
        (points.angle_plus_arcsec + points.angle_minus_arcsec) / 2,
        points.torque_Nm,
        np.array([code[u] for u in points.unit]),
        prediction.compliance_std,
        prediction.gap_std_arcsec,
        readings(_resolution(angles), total),
    )
    return deviations, names


def _resolution(angles: np.ndarray) -> float:
    """The coarsest step of which all angles are multiples; 0 where none is."""
    for step in RESOLUTIONS:  # 1e-6 of a step: decimals are off by their last bit
        if np.abs(angles / step - np.round(angles / step)).max() < 1e-6:
            return step
    return 0.0


def unit_findings(
    points: EndPoints,
    deviations: UnitDeviations,
    names: Sequence[str],
    envelopes: Sequence[Envelope],
) -> tuple[UnitFinding, ...]:
    """Every unit at the torque where it is furthest out."""
    at = {e.torque_Nm: e for e in envelopes}
    looked = len(names) * min(2, len(envelopes))  # further torques of a unit share its clearance
    total = points.total_arcsec
    findings = []
    for name, rows in zip(names, deviations.unit_rows, strict=True):
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
        findings.append(UnitFinding(
            name, of.torque_Nm, float(total[i]), of.total_arcsec, of.std_arcsec, float(deviations.mid[i]),
            z, p, float(-np.expm1(looked * np.log1p(-min(p, LARGEST_P_VALUE)))),
            of.explanation(float(total[i])),
        ))  # fmt: skip
    return tuple(findings)


def mid_positions(deviations: UnitDeviations, prediction: Prediction) -> MidPositions:
    """Where the units' mid positions lie."""
    each = [float(deviations.mid[rows].mean()) for rows in deviations.unit_rows]
    return MidPositions(tuple(each), float(deviations.torque.max()) * prediction.compliance)
