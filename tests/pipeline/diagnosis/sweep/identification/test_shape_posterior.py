"""A size whose shape is fitted too is known no better than the shape lets it."""

from __future__ import annotations

import numpy as np
import pytest
from histories import PREDICTION, sweep
from scipy.optimize import curve_fit

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    gaussian_evidence,
    with_shapes,
)
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import design_matrix
from flexspline.pipeline.diagnosis.sweep.evidence.shape_tuning import tuned
from flexspline.pipeline.diagnosis.sweep.identification.shape_posterior import magnitude_stds

DRIFT = "sensor_drift"
HISTORY = sweep(cycles=3, rows=150, hold=0)
RIG = FitContext(PREDICTION, HISTORY)
NOISE = 1.0
EXPONENT, ARCSEC = 0.8, 12.0
"""Of the true drift, θ = 12″·(t/duration)^0.8: strong enough that priors add nothing to what 450 rows say."""


def share_of_record() -> np.ndarray:
    assert HISTORY.time_s is not None
    return HISTORY.time_s / RIG.duration_s


def fitted(angle_arcsec: np.ndarray) -> SweepFit:
    """Drift as a power of time, its exponent tuned."""
    columns = design_matrix(RIG, {DRIFT: known_causes()[DRIFT]})
    kept = np.ones(len(HISTORY), bool)
    evidence = gaussian_evidence(columns, angle_arcsec, kept, Noise(NOISE**2, 0.0, 0.5))
    first = next(i for i, t in enumerate(evidence.terms) if t.owner == DRIFT)
    evidence = with_shapes(evidence, tuned(evidence, [first]).shapes)
    return fit_regressors(evidence, [len(evidence.terms) - 1])


def measured(seed: int) -> np.ndarray:
    noise = np.random.default_rng(seed).normal(0, NOISE, len(HISTORY))
    return ARCSEC * share_of_record() ** EXPONENT + noise


def stated(fit: SweepFit) -> float:
    return magnitude_stds(fit, fit.magnitude_slopes())[DRIFT]


def with_shape_known(fit: SweepFit) -> float:
    slope = fit.magnitude_slopes()[DRIFT]
    return float(np.sqrt(slope @ fit.posterior.covariance @ slope))


def test_the_deviation_is_that_of_scipy_s_nonlinear_fit() -> None:
    """Of size and exponent beside zero, compliance and gap, all free."""
    fit = fitted(measured(1))
    base = fit.evidence.columns.base[:, :3]
    free = fit.evidence.columns.base_prior[:3]

    def angle(_: object, size: float, exponent: float, *calibrated: float) -> np.ndarray:
        return size * share_of_record() ** exponent + base @ calibrated

    start = (ARCSEC, EXPONENT, 0.0, 0.0, 0.0)
    data = np.concatenate([measured(1), np.zeros(3)])  # the priors as three more measurements

    def with_priors(x: object, *unknown: float) -> np.ndarray:
        return np.concatenate([angle(x, *unknown), unknown[2:]])

    sigma = np.concatenate([np.full(len(HISTORY), NOISE), free])
    found, covariance = curve_fit(
        with_priors, None, data, p0=start, sigma=sigma, absolute_sigma=True
    )
    hours = RIG.duration_s / 3600
    assert fit.magnitudes()[DRIFT] == pytest.approx(found[0] / hours, rel=0.01)
    # priors of size and exponent, and base columns of the torque's noise, are not in scipy's
    assert stated(fit) == pytest.approx(np.sqrt(covariance[0, 0]) / hours, rel=0.05)
    assert with_shape_known(fit) < 0.9 * stated(fit)


def test_sizes_scatter_by_the_deviation() -> None:
    """Of 50 records that differ by noise alone; their scatter is known to 10 %, two of which are allowed."""
    fits = [fitted(measured(100 + k)) for k in range(50)]
    scatter = np.std([f.magnitudes()[DRIFT] for f in fits])
    assert np.mean([stated(f) for f in fits]) == pytest.approx(scatter, rel=0.2)


def test_a_shape_without_parameters_adds_nothing() -> None:
    spring = "series_compliance"
    columns = design_matrix(RIG, {spring: known_causes()[spring]})
    kept = np.ones(len(HISTORY), bool)
    evidence = gaussian_evidence(columns, measured(1), kept, Noise(NOISE**2, 0.0, 0.5))
    fit = fit_regressors(evidence, [0])
    slopes = fit.magnitude_slopes()
    by_posterior = np.sqrt(slopes[spring] @ fit.posterior.covariance @ slopes[spring])
    assert magnitude_stds(fit, slopes)[spring] == pytest.approx(by_posterior, rel=1e-9)
