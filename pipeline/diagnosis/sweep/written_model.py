"""The model that is written: fitted with what stands in it, and with nothing else."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from math import sqrt

import numpy as np

from flexspline.pipeline.diagnosis.measurement.encoder_step import ROUNDING_RATIO, encoder_step
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.model.doubt import MOST_PARAMETERS, PredictionUncertainty
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.span import span_of
from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.sweep.evidence import GaussianEvidence
from flexspline.pipeline.diagnosis.sweep.fit import SweepFit, fit_regressors, model_of
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep, FoundAhead


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
    are fitted again without: fitted beside terms that are left out, they make up for what is not there.
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
        _covariance(fit, model, explained.ahead),
        span_of(sweep.history),
    )
    return WrittenModel(model, doubt)


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


def _covariance(fit: SweepFit, model: ExtendedModel, ahead: FoundAhead | None) -> np.ndarray:
    """(p, p) of the model's parameters in the order of `model.doubt.parameter_columns`.

    An element that the fit did not estimate has zeros, but for the deviation of friction ahead of the teeth,
    which was found apart. (0, 0) where there are too many.
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
    for cause_id, elements in model.elements.items():
        for e in elements:
            key = cause_id, tuple(sorted(e.shape.items()))
            at += fitted.get(key, [-1] * len(e.amplitudes))
    if len(at) > MOST_PARAMETERS:
        return np.empty((0, 0))
    chosen, known = np.array(at), np.array(at) >= 0
    found = np.where(np.outer(known, known), fit.posterior.covariance[np.ix_(chosen, chosen)], 0.0)
    if ahead is not None:  # the first of the friction's elements, and the only one not fitted
        place = int(np.flatnonzero(~known)[0])
        found[place, place] = ahead.torque_std_Nm**2
    return found
