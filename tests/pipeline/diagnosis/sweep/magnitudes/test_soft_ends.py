"""A gap whose ends are soft, as teeth take up their load one after another, beside a true wind-up."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from read_sweep import as_read, history_of, steps

from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.sweep.magnitudes.magnitudes import magnitudes
from flexspline.pipeline.diagnosis.sweep.magnitudes.soft_ends import soft_ends
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep, run_race

COMPLIANCE, GAP_ARCSEC, LARGEST_Nm = 10.0, 45.0, 40.0

Law = Callable[[np.ndarray], np.ndarray]
"""From 0 at torque 0 to 1, of torque over a width."""


def in_sum(x: np.ndarray) -> np.ndarray:
    """Teeth of which as many touch as are left, in proportion: 1 − e^(−x)."""
    return np.asarray(1 - np.exp(-x))


def explained(twist: np.ndarray, torque: np.ndarray) -> ExplainedSweep:
    history = history_of(steps(LARGEST_Nm, 100), 4)
    rng = np.random.default_rng(3)
    sweep = as_read(history, COMPLIANCE * torque + twist + rng.normal(0, 0.15, len(torque)))
    return run_race(prepare(sweep, Prediction(COMPLIANCE, 0.3, GAP_ARCSEC, 5.0)))


def torque_of() -> np.ndarray:
    return history_of(steps(LARGEST_Nm, 100), 4).torque_Nm


@pytest.mark.parametrize("law", [np.tanh, in_sum])
@pytest.mark.parametrize("width_Nm", [1.0, 2.0, 3.0])
def test_what_soft_ends_explain_is_within_what_is_stated(law: Law, width_Nm: float) -> None:
    """The gap as simulated, no wind-up and the compliance as simulated: all three within two deviations."""
    torque = torque_of()
    told = explained(GAP_ARCSEC / 2 * law(np.abs(torque) / width_Nm) * np.sign(torque), torque)
    found = calibration_of(told)
    assert found.compliance is not None
    assert abs(found.gap_arcsec.value - GAP_ARCSEC) < 2 * found.gap_arcsec.std
    assert abs(found.compliance.value - COMPLIANCE) < 2 * found.compliance.std
    sizes, stds = magnitudes(told.identified)
    none = {"stiffness_hardening": 1.0, "clearance_offset": 0.0}
    for cause in {*none} & {*sizes} & {*stds}:
        assert abs(sizes[cause] - none[cause]) < 2 * stds[cause]


@pytest.mark.parametrize("knee", [0.15, 0.3])
def test_a_wind_up_beyond_the_gap_is_none_of_its_ends(knee: float) -> None:
    """40 arcsec to either side, that end at a share of the largest torque: no soft ends last so long."""
    torque = torque_of()
    soft = 40.0 * np.minimum(np.abs(torque) / LARGEST_Nm / knee, 1.0)
    told = explained((GAP_ARCSEC / 2 + soft) * np.sign(torque), torque)
    ends = soft_ends(told.identified.fit)
    assert sum(ends.shares) < 1e-3
    assert "stiffness_hardening" in told.identified.named
