"""From the evidence of end points to extended models, and their error on units left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.calibration import Calibration, Estimate
from flexspline.pipeline.diagnosis.causes.cause import Element, FitContext
from flexspline.pipeline.diagnosis.end_points.evidence import (
    UnitDeviations,
    UnitEvidence,
    unit_evidence,
)
from flexspline.pipeline.diagnosis.end_points.finding import UnitFinding
from flexspline.pipeline.diagnosis.end_points.race import Hypothesis
from flexspline.pipeline.diagnosis.end_points.regressors import (
    EndPointRegressor,
    end_point_regressors,
)
from flexspline.pipeline.diagnosis.left_out import LeftOut
from flexspline.pipeline.diagnosis.measurement.record import EndPoints
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.robust import rms

FEWEST_UNITS = 3
"""Fewest units, so that one can be held out and two still show what is common."""


def calibration_of(evidence: UnitEvidence, prediction: Prediction) -> Calibration:
    """The gap that all units share; the compliance stays as simulated."""
    off, std = evidence.common
    return Calibration(Estimate(prediction.gap_arcsec + off, std), bool(evidence.terms))


def extended(
    evidence: UnitEvidence, deviations: UnitDeviations, names: Sequence[str], prediction: Prediction
) -> ExtendedModel:
    """The calibrated simulation with the terms of a hypothesis; a unit's own gap beside the common one."""
    elements: dict[str, tuple[Element, ...]] = {}
    for term, amplitude in zip(evidence.terms, evidence.mean, strict=True):
        elements[term.cause] = elements.get(term.cause, ()) + term.elements(float(amplitude))
    return ExtendedModel(
        prediction.compliance,
        calibration_of(evidence, prediction).gap_arcsec.value,
        {
            n: float(deviations.mid[rows].mean())
            for n, rows in zip(names, deviations.unit_rows, strict=True)
        },
        elements,
        {n: (0.0, float(evidence.own[u])) for u, n in enumerate(names)},
    )


def rivals_for_unit(
    points: EndPoints,
    rig: FitContext,
    prediction: Prediction,
    unit: UnitFinding,
    ids: Sequence[str],
) -> list[ExtendedModel]:
    """One model for each cause, its amplitude such that the unit's excess is explained by it alone.

    Of a cause's shapes, the first whose sign is possible.
    """
    excess = unit.total_arcsec - unit.predicted_arcsec
    row = points.torque_Nm == unit.torque_Nm
    models = []
    for cause in ids:
        for term in end_point_regressors(points, rig):
            column = float(term.column[row][0])
            if term.cause != cause or term.channel != "total" or column == 0:
                continue
            amplitude = excess / column
            if amplitude < 0 and term.positive:
                continue
            models.append(_model(prediction, term, amplitude))
            break
    return models


def _model(prediction: Prediction, term: EndPointRegressor, amplitude: float) -> ExtendedModel:
    elements = {term.cause: term.elements(amplitude)}
    return ExtendedModel(prediction.compliance, prediction.gap_arcsec, {}, elements, {})


def gain_of(
    deviations: UnitDeviations, best: Hypothesis, names: Sequence[str], rows: np.ndarray
) -> Gain | None:
    """Each unit in turn predicted from the others; errors of totals [arcsec].

    `rows` : (n,) of the file, that the deviations are of. None for what is one unit's own, which no other
    unit can predict, and for fewer than three units.
    """
    if deviations.units < FEWEST_UNITS or best.own is not None:
        return None
    terms = [t for t in best.best.terms if t.channel == "total"]
    calibrated, after = deviations.deviation.copy(), deviations.deviation.copy()
    for u in range(deviations.units):
        out = deviations.unit == u
        _, unit = np.unique(deviations.unit[~out], return_inverse=True)
        rest = replace(
            deviations,
            deviation=deviations.deviation[~out],
            mid=deviations.mid[~out],
            torque=deviations.torque[~out],
            unit=unit,
        )
        calibrated[out] -= unit_evidence(rest, ()).common[0]
        trained = unit_evidence(rest, [replace(t, column=t.column[~out]) for t in terms])
        after[out] -= trained.common[0]
        for term, amplitude in zip(terms, trained.mean, strict=True):
            after[out] -= amplitude * term.column[out]
    return Gain(
        LeftOut("unit", each=len(names)), rms(deviations.deviation), rms(calibrated), rms(after),
        best.best.reading, held_out_rows=tuple(map(int, rows)),
    )  # fmt: skip
