"""How well sizes are known where the shapes of the causes are fitted beside them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.evidence.shape_tuning import (
    LOG_DIFFERENCE,
    columns_with_shapes,
    tunable,
)


def magnitude_stds(fit: SweepFit, slopes: dict[str, np.ndarray]) -> dict[str, float]:
    """Standard deviation of each magnitude, in its unit, by the posterior of amplitudes and shapes together.

    To first order about the fit (Laplace). The continuous parameters of the shapes are unknowns as in a
    step of `../evidence/shape_tuning.py`, with its prior: a size that follows a shape is no better known
    than the shape.

    Parameters: slopes, of each magnitude for each amplitude (`SweepFit.magnitude_slopes`).
    """
    keys, covariance = _with_shapes(fit)
    scale = _scale(fit)
    by_shape = _shape_slopes(fit, keys)
    of_all = {c: np.concatenate([s * scale, by_shape[c]]) for c, s in slopes.items()}
    return {c: float(np.sqrt(s @ covariance @ s)) for c, s in of_all.items()}


def calibration_covariance(fit: SweepFit) -> np.ndarray:
    """(b, b) of zeros, compliance, gap and the torque's noise, by the same posterior."""
    b = fit.posterior.base_count
    return _with_shapes(fit)[1][:b, :b]


def _with_shapes(fit: SweepFit) -> tuple[list[tuple[int, str]], np.ndarray]:
    """Tuned parameters; covariance (p + k, p + k) of amplitudes at unit prior and of these parameters."""
    evidence, posterior, terms = fit.evidence, fit.posterior, fit.regressors
    shapes = [t.shape for t in terms]
    keys = tunable(terms, shapes)
    blocks = [evidence.x[:, t.at] for t in terms]
    amplitude = (posterior.mean / _scale(fit))[posterior.base_count :]
    whole, prior = columns_with_shapes(evidence, terms, shapes, blocks, keys, amplitude)
    return keys, np.linalg.inv(whole.T @ whole + np.diag(prior))


def _scale(fit: SweepFit) -> np.ndarray:
    """(p,) deviations of the priors by which columns are scaled; the calibration's are as they are."""
    own = (fit.evidence.scale[t.at] for t in fit.regressors)
    return np.concatenate([np.ones(fit.posterior.base_count), *own])


def _shape_slopes(fit: SweepFit, keys: list[tuple[int, str]]) -> dict[str, np.ndarray]:
    """(k,) of each magnitude for the log of each parameter, the amplitudes at unit prior as they are."""
    at_fit = fit.magnitudes()
    slopes = {c: np.zeros(len(keys)) for c in at_fit}
    for i, (j, key) in enumerate(keys):
        for c, value in _moved(fit, j, key).magnitudes().items():
            slopes[c][i] = (value - at_fit[c]) / LOG_DIFFERENCE
    return slopes


def _moved(fit: SweepFit, j: int, key: str) -> SweepFit:
    """The fit with one parameter of its term j a step further."""
    evidence, posterior = fit.evidence, fit.posterior
    term = fit.regressors[j]
    assert term.cause is not None
    shape = {**term.shape, key: term.shape[key] * float(np.exp(LOG_DIFFERENCE))}
    rig = evidence.columns.rig
    terms = list(evidence.terms)
    terms[posterior.terms[j]] = replace(term, shape=shape)
    first = posterior.base_count + sum(t.width for t in fit.regressors[:j])
    mean = posterior.mean.copy()
    mean[first : first + term.width] *= term.cause.spread(shape, rig) / evidence.scale[term.at]
    columns = replace(evidence.columns, terms=tuple(terms))
    return SweepFit(replace(evidence, columns=columns), replace(posterior, mean=mean))
