"""What calibrating stiffness and gap alone can do, and how a gear stiffer than simulated is worded."""

from __future__ import annotations

import numpy as np
import pytest
from histories import LARGEST, PREDICTION
from histories import sweep as swept

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Rig
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.sweep.calibrated import ALLOWED, calibrated_residual, less_zero
from flexspline.pipeline.diagnosis.sweep.evidence import GaussianEvidence, gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.regressors import design_matrix

SIGMA = 0.5


def raced(compliance: float, gap: float) -> GaussianEvidence:
    """A record that lacks nothing but so many standard deviations of stiffness and gap."""
    history = swept(cycles=2)
    columns = design_matrix(
        Rig(PREDICTION, history), {"clearance_offset": known_causes()["clearance_offset"]}
    )
    target = columns.base[:, 1:3] @ (np.array([compliance, gap]) * columns.base_prior[1:3])
    kept = np.abs(history.torque_Nm) > 0.07 * LARGEST
    return gaussian_evidence(columns, target, kept, Noise(SIGMA**2, 0.0, 0.5))


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def test_within_its_doubt_the_calibration_takes_all_away() -> None:
    now = raced(1.0, -1.0)
    before = rms(less_zero(now.target, now.kept, now.columns.rig.history)[now.kept])
    # the prior pulls the calibration back by what the noise lets it: far below a tenth
    assert rms(calibrated_residual(now)[now.kept]) < 0.1 * before


@pytest.mark.parametrize(("compliance", "gap"), [(8.0, -8.0), (-8.0, 8.0), (8.0, 1.0), (-1.0, 8.0)])
def test_no_other_calibration_within_its_limits_is_better(compliance: float, gap: float) -> None:
    """Against a fine grid of both; stiffness and gap look alike, so limits one by one are not the best."""
    now = raced(compliance, gap)
    history, base, prior = now.columns.rig.history, now.columns.base, now.columns.base_prior
    ends = np.linspace(-ALLOWED, ALLOWED, 41)
    tried = [
        rms(
            less_zero(
                now.target - base[:, 1:3] @ (np.array([c, g]) * prior[1:3]), now.kept, history
            )[now.kept]
        )
        for c in ends
        for g in ends
    ]
    # the prior counts against each calibration too, as 4 of some thousand squares at the limit
    assert rms(calibrated_residual(now)[now.kept]) <= min(tried) * 1.01
