"""The torque's noise drives a memory of the torque too: a trace of it is no cause, a lag beyond it is one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import PREDICTION, sweep
from read_sweep import as_read

from flexspline.pipeline.diagnosis.causes.operators import lags
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep

pytestmark = pytest.mark.usefixtures("causes_only")

HISTORY = replace(sweep(cycles=12, rows=200, hold=0), temperature_C=None, input_angle_deg=None)
TORQUE_NOISE_Nm, ANGLE_NOISE = 0.02, 0.05
"""0.2 arcsec by the compliance, known to 4 milliarcsec from 2400 rows; arcsec."""


def lagging(share: float, seed: int) -> DiagnosisOutcome:
    """A twist that lags by 20 s, its rms a share of what the torque's noise is in the angle."""
    rng, torque = np.random.default_rng(seed), HISTORY.torque_Nm
    behind = torque - lags(torque, HISTORY, np.array([20.0]))[:, 0]
    size = share * PREDICTION.compliance * TORQUE_NOISE_Nm
    angle = PREDICTION.angle_arcsec(HISTORY) - size * behind / behind.std()
    angle = angle + ANGLE_NOISE * rng.normal(size=len(HISTORY))
    read = replace(HISTORY, torque_Nm=torque + TORQUE_NOISE_Nm * rng.normal(size=len(HISTORY)))
    return diagnose_sweep(as_read(read, angle), PREDICTION)[0]


def test_a_tenth_of_the_torque_s_noise_is_no_lag() -> None:
    assert lagging(0.1, 3).verdict == "consistent"


def test_three_times_the_torque_s_noise_is_a_lag() -> None:
    """By its rate, or friction of some spread: the cycles' straight ramps have one rate."""
    found = lagging(3.0, 5)
    assert [(c.id, c.alternatives) for c in found.causes] == [
        ("rate_dependence", ("friction_hysteresis",))
    ]
