"""How much the misfit of one cause's shape changes the sizes of the others, which absorb a part of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.measurement.floors import LEAST_ANGLE_ARCSEC
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    column_indices,
)

SHAPE_MISFIT = 2.0
"""Rms that the best shape leaves of a law, over the doubt of its size: 1.4 of a rate's, 2 of a creep's."""


def leaked(fit: SweepFit, slopes: dict[str, np.ndarray]) -> dict[str, float]:
    """Deviation of each cause's magnitude, in its unit, by the others' shapes.

    A gear's law lies between the shapes that are tried. Each other shape of a cause, as large beyond the
    calibration as what was found, is fitted by the set as it is: the set leaves d of it, and other causes
    take up e. A law that differs from the best shape in this direction, by the share of its rms that the
    doubt of its shape is, moves them by e·doubt·rms/|d|, by e at the most. Of all directions this is the
    root mean square.

    Parameters: slopes, of each magnitude for each amplitude (`SweepFit.magnitude_slopes`).
    """
    evidence, posterior = fit.evidence, fit.posterior
    b, owners = posterior.base_count, _owners(fit)
    causes = [c for c in dict.fromkeys(owners[b:]) if not c.startswith("?")]
    leaks = {c: 0.0 for c in (*causes, *fit.elements())}
    if len(leaks) < 2:
        return leaks
    at = column_indices(evidence, posterior.terms)
    model = np.hstack([evidence.base, evidence.x[:, at]])
    scale = np.concatenate([np.ones(b), evidence.scale[at]])
    inverse = posterior.covariance / np.outer(scale, scale)
    for cause in causes:
        mine = owners == cause
        size = effect_size(fit, cause)
        others = [
            t.at.start
            for t in evidence.terms
            if t.owner == cause and t.width == 1 and t.at.start not in at
        ]
        length = lengths_beyond_calibration(evidence, others)
        tried = evidence.x[:, others][:, length > 0] * (size / length[length > 0])
        if tried.shape[1] == 0:
            continue
        taken = inverse @ (model.T @ tried)
        left = np.linalg.norm(tried - model @ taken, axis=0)
        doubt = SHAPE_MISFIT * known_causes()[cause].shape_doubt * size
        share = np.minimum(1.0, doubt / np.maximum(left, LEAST_ANGLE_ARCSEC))
        moved = (taken * scale[:, None])[~mine] * share
        for other in leaks:
            if other != cause:
                error = slopes[other][~mine] @ moved
                leaks[other] = float(np.hypot(leaks[other], rms(error)))
    return leaks


def lengths_beyond_calibration(evidence: GaussianEvidence, columns: Sequence[int]) -> np.ndarray:
    """(k,) length of columns beyond what the calibration takes up of them, in deviations of the noise.

    Hardening is a spring too, and a change of compliance is no shape.
    """
    return np.sqrt(np.maximum(np.diag(evidence.gram)[columns], 0.0))


def effect_size(fit: SweepFit, cause: str) -> float:
    """Length of a cause's effect over the rows beyond the calibration, in deviations of the noise."""
    evidence, posterior = fit.evidence, fit.posterior
    at = column_indices(evidence, posterior.terms)
    scaled = posterior.mean[posterior.base_count :] / evidence.scale[at]
    mine = np.where(_owners(fit)[posterior.base_count :] == cause, scaled, 0.0)
    return float(np.sqrt(max(mine @ evidence.gram[np.ix_(at, at)] @ mine, 0.0)))


def _owners(fit: SweepFit) -> np.ndarray:
    """(p,) owner of each amplitude; empty of the calibration's."""
    owners = [""] * fit.posterior.base_count
    for t in fit.regressors:
        owners += [t.owner] * t.width
    return np.array(owners)
