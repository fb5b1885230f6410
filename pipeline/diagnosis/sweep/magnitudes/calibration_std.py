"""Compliance and gap as a record has them, with all that leaves them open: not the noise alone."""

from __future__ import annotations

from dataclasses import replace
from math import copysign, hypot, sqrt

import numpy as np

from flexspline.pipeline.diagnosis.calibration import Calibration, Estimate
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import LEAST_PRIOR, Regressor
from flexspline.pipeline.diagnosis.sweep.identification.shape_posterior import (
    calibration_covariance,
)
from flexspline.pipeline.diagnosis.sweep.magnitudes.cancelling_terms import (
    terms_cancel,
    without_unnamed,
)
from flexspline.pipeline.diagnosis.sweep.magnitudes.long_lags import long_lags
from flexspline.pipeline.diagnosis.sweep.magnitudes.magnitudes import fits_alike
from flexspline.pipeline.diagnosis.sweep.magnitudes.rounding_error import RoundingError
from flexspline.pipeline.diagnosis.sweep.magnitudes.soft_ends import soft_ends
from flexspline.pipeline.diagnosis.sweep.magnitudes.spring_changes import spring_std
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.written_model import beside_friction

NEIGHBOUR_SHARE = 0.5
"""Of the way to a neighbouring law: the nearest one is found."""


def calibration_of(
    explained: ExplainedSweep, unit: int | None = None, misread: bool = False
) -> Calibration:
    """What the units have in common, or one unit's own, by the best set.

    The deviations have five parts: that of the posterior; that of the torque of friction ahead of the gap,
    for which the posterior holds; the mean distance of other shapes' fits; what the encoder's rounding makes
    of a gear within a step of the fitted one; and, of the compliance, what
    friction takes at the ends of its loop, or the load at which a soft wind-up is as stiff as simulated: each
    is the same but for a compliance, and no row tells. Shapes leave it no more open than the design states,
    or than it is off.

    A wind-up near zero torque may be the soft ends of a gap (`soft_ends.py`): the deviations contain the
    distance to that explanation, as far as it is likely.

    Beside terms without a name that cancel each other any compliance and gap fit, and those of a record that
    was `misread` are what a late reading makes of gap and compliance. Then they are those of the simulation
    with the named causes alone, and differ from the best set's by a deviation more.
    """
    calibration = _of_best_set(explained, unit)
    if misread or terms_cancel(explained.identified):
        calibration = _both(_calibrated(without_unnamed(explained.identified), unit), calibration)
    for others in (long_lags(explained.identified.fit), soft_ends(explained.identified.fit)):
        for other, share in zip(others.fits, others.shares, strict=True):
            calibration = _both(calibration, _calibrated(other, unit), share)
    return calibration


def _both(calibration: Calibration, other: Calibration, share: float = 1.0) -> Calibration:
    """A calibration whose deviations contain the distance to another one, which is as likely as its share."""
    return replace(
        calibration,
        gap_arcsec=_apart(calibration.gap_arcsec, other.gap_arcsec, share),
        compliance=calibration.compliance
        and other.compliance
        and _apart(calibration.compliance, other.compliance, share),
    )


def _apart(simple: Estimate, other: Estimate, share: float) -> Estimate:
    off = sqrt(share) * (simple.value - other.value)
    return Estimate(simple.value, hypot(simple.std, off))


def _of_best_set(explained: ExplainedSweep, unit: int | None) -> Calibration:
    fit = explained.identified.fit
    calibration = _calibrated(_with_shapes(fit), unit)
    slope, gap = _beside_ahead(explained)
    fits, weight = fits_alike(explained.identified)
    others = [_calibrated(other, unit) for other in fits]
    away = weight @ np.abs([o.gap_arcsec.value - calibration.gap_arcsec.value for o in others])
    soft_slope, soft_gap = _softening_std(fit, unit)
    read_slope, read_gap = _rounding_std(explained, fit, unit)
    of_gap = hypot(calibration.gap_arcsec.std, gap, away, soft_gap, read_gap)
    calibration = replace(calibration, gap_arcsec=Estimate(calibration.gap_arcsec.value, of_gap))
    if (own := calibration.compliance) is None:
        return calibration
    values = [own.value if o.compliance is None else o.compliance.value for o in others]
    away = weight @ np.abs(np.array(values) - own.value)
    prediction = fit.rig.prediction
    most = max(own.std, prediction.compliance_std, abs(own.value - prediction.compliance))
    parts = (own.std, slope, away, soft_slope, read_slope, _untold_std(fit, own.value))
    std = min(hypot(*parts), most)
    return replace(calibration, compliance=Estimate(own.value, std))


def _with_shapes(fit: SweepFit) -> SweepFit:
    """The fit, its calibration as well known as where the causes' shapes are fitted beside it."""
    b = fit.posterior.base_count
    covariance = fit.posterior.covariance.copy()
    covariance[:b, :b] = calibration_covariance(fit)
    return replace(fit, posterior=replace(fit.posterior, covariance=covariance))


def _rounding_std(
    explained: ExplainedSweep, fit: SweepFit, unit: int | None
) -> tuple[float, float]:
    """Deviations of compliance and gap by the encoder's steps."""
    error = RoundingError.of(explained.prepared, fit)
    slope, gap = np.zeros((2, len(fit.posterior.mean)))
    for first in (fit.units, *(() if unit is None else (fit.units + 2 + 2 * unit,))):
        slope[first] = gap[first + 1] = 1.0
    return error.std(slope), error.std(gap)


def _softening_std(fit: SweepFit, unit: int | None) -> tuple[float, float]:
    """Deviations of compliance and gap by the law of a bend of the curve, which has no name.

    Between the law found and its neighbours, of another power or load, lie those that were not tried.
    """
    terms, chosen = fit.evidence.terms, fit.posterior.terms
    calibration = _calibrated(fit, unit)
    off = [(0.0, 0.0)]
    for i in chosen:
        if _bend(terms[i]) is None:
            continue
        for j in (i - 1, i + 1):
            if j not in range(len(terms)) or j in chosen or _bend(terms[j]) != _bend(terms[i]):
                continue
            other = fit_regressors(fit.evidence, [j if k == i else k for k in chosen])
            next_one = _calibrated(other, unit)
            slope = 0.0
            if calibration.compliance is not None and next_one.compliance is not None:
                slope = next_one.compliance.value - calibration.compliance.value
            off.append((slope, next_one.gap_arcsec.value - calibration.gap_arcsec.value))
    slope, gap = (NEIGHBOUR_SHARE * np.abs(off).max(axis=0)).tolist()
    return slope, gap


def _bend(term: Regressor) -> float | None:
    """The side of a bend without a name, 0 of both; None of other terms."""
    if term.form is None or term.form.kind not in ("softening", "one_sided"):
        return None
    return copysign(1.0, term.form.at_Nm) if term.form.at_Nm is not None else 0.0


def _calibrated(fit: SweepFit, unit: int | None) -> Calibration:
    return fit.calibration if unit is None else fit.calibration_of(unit)


def _beside_ahead(explained: ExplainedSweep) -> tuple[float, float]:
    """Deviations of common compliance and gap by that of the torque of friction ahead of the gap."""
    if explained.ahead is None:
        return 0.0, 0.0
    fit = explained.identified.fit
    with_friction = np.diag(beside_friction(fit, explained))[:-1] - np.diag(
        fit.posterior.covariance
    )
    slope, gap = with_friction[fit.units : fit.units + 2]
    return sqrt(max(slope, 0.0)), sqrt(max(gap, 0.0))


def _untold_std(fit: SweepFit, compliance: float) -> float:
    """Of a compliance, by shapes that differ in it alone; each counts as the design's stated doubt has it.

    Of a compliance that lies beyond that doubt it is too small; it is then taken as large as the distance.
    """
    prediction = fit.rig.prediction
    change = compliance - prediction.compliance
    doubt = max(prediction.compliance_std, abs(change), LEAST_PRIOR)

    def likely(changes: np.ndarray) -> np.ndarray:
        off = (changes + change) / doubt
        return np.asarray(np.exp(((change / doubt) ** 2 - off**2) / 2).clip(max=1.0))

    return spring_std(fit, likely)
