"""The residual of the simulation alone, calibrated within its stated uncertainty."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    gaussian_evidence,
)
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import (
    NOISE_COLUMNS,
    DesignMatrix,
    base_columns,
)

ALLOWED_SIGMAS = 2.0
"""Standard deviations by which a calibration may move without being a finding: the usual 95 %."""


def calibrated_residual(evidence: GaussianEvidence) -> np.ndarray:
    """(n,) measured less the simulation alone, calibrated on the race's rows as far as its doubt goes.

    Stiffness and gap, common and each unit's own, move by no more than `ALLOWED_SIGMAS` of their stated
    standard deviations, and the best within those limits is taken; zeros are free.
    """
    from scipy.optimize import lsq_linear

    columns = evidence.columns
    if columns.ahead is not None or columns.rig.prediction.measured_bend is not None:
        evidence = _as_simulated(evidence)
    history = evidence.columns.rig.history
    units = len(history.unit_slices)
    limited = slice(units, units + 2 + (2 * units if units > 1 else 0))
    limit = np.full(len(evidence.base_right), np.inf)
    limit[limited] = ALLOWED_SIGMAS * evidence.columns.base_prior[limited]
    # the fit's normal equations G x = b as least squares: G = L Lᵀ, so |Lᵀx − L⁻¹b|² is its misfit
    lower = np.linalg.cholesky(evidence.base_gram)
    mean = lsq_linear(lower.T, np.linalg.solve(lower, evidence.base_right), (-limit, limit)).x
    seen = evidence.columns.base[:, limited] @ mean[limited]
    return less_zero(evidence.target - seen, evidence.kept, history)


def _as_simulated(evidence: GaussianEvidence) -> GaussianEvidence:
    """The calibration alone, with the simulated bend, and all torque read as the gear's, also what friction
    carries ahead of the teeth."""
    old = evidence.columns
    teeth, prediction = old.rig.history, old.rig.prediction
    carried = 0.0 if old.ahead is None else old.ahead.carried_Nm
    read = replace(teeth, torque_Nm=teeth.torque_Nm + carried)
    rig = replace(old.rig, history=read)
    base, prior = base_columns(rig, old.base[:, -NOISE_COLUMNS:])
    begun = prediction.for_race.angle_arcsec(teeth)
    target = evidence.target + begun - prediction.angle_arcsec(read)
    return gaussian_evidence(
        DesignMatrix(rig, base, prior, old.all[:, :0], ()), target, evidence.kept, evidence.noise
    )


def less_zero(values: np.ndarray, rows: np.ndarray, history: History) -> np.ndarray:
    """(n,) values less each unit's mean over the given rows (mask); over all where it has none."""
    out = values.copy()
    for own in history.unit_slices:
        chosen = own[rows[own]]
        out[own] -= values[chosen if len(chosen) else own].mean()
    return out
