"""The model that is written: fitted with its own terms only."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.measurement.encoder_step import ROUNDING_RATIO, encoder_step
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.model.doubt import (
    MOST_PARAMETERS,
    PredictionUncertainty,
    crossing_variance,
    unsure_of,
)
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.span import span_of
from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors, model_of
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import GaussianEvidence
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import true_history
from flexspline.pipeline.diagnosis.sweep.race.friction_ahead_tuning import amplitudes_per_Nm
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep

CROSSING_WIDTHS, NARROWEST_CROSSING = 24, 0.01
"""Widths tried of the gap's crossing, up to the band of rows that no fit uses, and the least of that band."""
SPREAD_NATS = 3.0
"""[nats] Least evidence over no width at which a width is written: odds of 20 to 1."""


@dataclass(frozen=True)
class WrittenModel:
    """The model, and what its predictions may be off by."""

    model: ExtendedModel
    doubt: PredictionUncertainty


def written_model(
    explained: ExplainedSweep, sweep: Sweep, named: Collection[str], gain: Gain | None
) -> WrittenModel:
    """The calibrated simulation with the named causes, by the best set's shapes.

    Where the best set has nuisance terms or minor causes beside them, zeros, stiffness, gap and amplitudes
    are fitted again without: fitted together with terms that are left out, they would compensate for them.
    """
    identified = explained.identified
    evidence, terms = identified.search.evidence, identified.best.terms
    kept = tuple(i for i in terms if (c := evidence.terms[i].cause) is not None and c.id in named)
    fit = identified.fit
    if kept != tuple(terms):
        fit = _refitted(evidence, kept) or fit
    model = model_of(fit, sweep, list(named), explained.offset_Nm)
    noise = explained.identified.fit.residual_as_read()[explained.prepared.kept]
    # a motion in step with the encoder leaves less here than its rounding will leave of another
    floor = max(rms(noise), encoder_step(sweep.angle_arcsec) / sqrt(ROUNDING_RATIO))
    of_row = max(floor, gain.rmse_after) if gain else floor
    if (averaging := explained.prepared.sweep.averaging) is not None:  # so far it is of means
        of_row = float(np.sqrt(of_row**2 + averaging.variance_within(model.compliance)))
    doubt = PredictionUncertainty(
        of_row,
        torque_noise_Nm(sweep.history),
        _covariance(fit, model, explained),
        span_of(sweep.history),
    )
    crossing = _crossing_Nm(fit, explained, model, doubt)
    return WrittenModel(model, replace(doubt, crossing_Nm=crossing))


def _crossing_Nm(
    fit: SweepFit, explained: ExplainedSweep, model: ExtendedModel, doubt: PredictionUncertainty
) -> float:
    """Torque over which the gap's crossing is spread beyond what else makes a row's side of it unsure.

    Soft ends and drag leave rows in the gap, where the model knows two sides alone. No fit uses the rows next
    to the crossing; what they are off by gives this torque, the likeliest if it is clearly so.
    """
    prepared = explained.prepared
    read, true = true_history(prepared.sweep, prepared.offset_Nm), prepared.rig.history
    near = ~prepared.outlier & (np.abs(true.torque_Nm) <= prepared.band_Nm)
    off = np.clip(np.abs(fit.residual_as_read()), 0.0, model.gap_arcsec)
    widths = np.r_[0.0, np.geomspace(NARROWEST_CROSSING, 1.0, CROSSING_WIDTHS) * prepared.band_Nm]
    nats = []
    for width in widths:
        unsure = unsure_of(model, replace(doubt, crossing_Nm=width))
        variance = doubt.reading_arcsec**2 + crossing_variance(model, read, true, unsure)
        each = -np.log(variance) / 2 - off**2 / (2 * variance)
        nats.append(float(each[near].sum()))
    best = int(np.argmax(nats))
    return float(widths[best]) if nats[best] > nats[0] + SPREAD_NATS else 0.0


def _refitted(evidence: GaussianEvidence, terms: tuple[int, ...]) -> SweepFit | None:
    """Fit of these terms without those that then have an amplitude that physics forbids.

    None where a cause would go with them.
    """
    causes = {evidence.terms[i].owner for i in terms}
    while {evidence.terms[i].owner for i in terms} == causes:
        fit = fit_regressors(evidence, terms)
        pairs = zip(terms, fit.posterior.amplitudes(evidence), strict=True)
        forbidden = {i for i, a in pairs if evidence.terms[i].positive and a.min() < 0}
        if not forbidden:
            return fit
        terms = tuple(i for i in terms if i not in forbidden)
    return None


def _covariance(fit: SweepFit, model: ExtendedModel, explained: ExplainedSweep) -> np.ndarray:
    """(p, p) of the model's parameters in the order of `model.doubt.parameter_columns`.

    An element that the fit did not estimate has zeros, but for friction ahead of the teeth, which was found
    apart. (0, 0) where there are too many.
    """
    k = fit.units
    at = list(range(k + 2 + (2 * k if k > 1 else 0)))
    place = fit.posterior.base_count
    fitted: dict[tuple[str, tuple[tuple[str, float], ...]], list[int]] = {}
    for i in fit.posterior.terms:
        term = fit.evidence.terms[i]
        if term.cause is not None:
            key = term.cause.id, tuple(sorted(term.shape.items()))
            fitted[key] = list(range(place, place + term.width))
        place += term.width
    whole = fit.posterior.covariance
    if explained.ahead is not None:
        whole = beside_friction(fit, explained)
        friction = model.elements[FRICTION][0]  # the only element that no term fits
        fitted[FRICTION, tuple(sorted(friction.shape.items()))] = [len(whole) - 1]
    for cause_id, elements in model.elements.items():
        for e in elements:
            key = cause_id, tuple(sorted(e.shape.items()))
            at += fitted.get(key, [-1] * len(e.amplitudes))
    if len(at) > MOST_PARAMETERS:
        return np.empty((0, 0))
    chosen, known = np.array(at), np.array(at) >= 0
    return np.where(np.outer(known, known), whole[np.ix_(chosen, chosen)], 0.0)


def beside_friction(fit: SweepFit, explained: ExplainedSweep) -> np.ndarray:
    """(p + 1, p + 1) covariance of a fit's parameters and, last, the torque of friction ahead of the teeth.

    The fit m holds for the torque F that was found apart. With its deviation σ the covariance
    P of the fit becomes P + m′m′ᵀσ², and m′σ² with F: what friction ahead lacks others have more of.
    """
    assert explained.ahead is not None
    slopes = amplitudes_per_Nm(explained.prepared, fit.evidence, fit.posterior.terms)
    with_own = np.r_[slopes, 1.0] * explained.ahead.torque_std_Nm
    whole = np.outer(with_own, with_own)
    whole[:-1, :-1] += fit.posterior.covariance
    return whole
