"""What stands in for what: an even curve is no two stiffnesses, a drift is not hidden by a warming room."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from histories import PREDICTION, sweep

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep

TURNING = sweep(cycles=8, rows=120, hold=0)


def diagnosed(history: History, added: np.ndarray) -> DiagnosisOutcome:
    """Read with noise of 0.5 arcsec and 0.01 N·m, which is 0.1 arcsec."""
    rng, torque = np.random.default_rng(4), history.torque_Nm
    noise = rng.normal(0, 0.5, len(torque))
    history = replace(history, torque_Nm=torque + rng.normal(0, 0.01, len(torque)))
    angle = 10.0 * torque + 30.0 * np.sign(torque) + added + noise
    record = Sweep(
        Path("rig.csv"), history, angle, ("",), (tuple(np.unique(history.cycle) + 1.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip
    return diagnose_sweep(record, PREDICTION)[0]


@pytest.mark.parametrize("height", [2.0, -6.0])
def test_an_even_curve_is_no_two_stiffnesses(height: float) -> None:
    """Both differ most by a fifth of the height, here 0.4 and 1.2 arcsec in 960 rows of 0.5."""
    history = replace(TURNING, temperature_C=None, input_angle_deg=None)
    outcome = diagnosed(history, height * (history.torque_Nm / 2.0) ** 2)
    assert outcome.verdict == "unknown"
    assert UnnamedForm("even_curve") in outcome.unexplained[0].structure


def test_two_stiffnesses_are_named() -> None:
    history = replace(TURNING, temperature_C=None, input_angle_deg=None)
    outcome = diagnosed(history, 0.5 * np.abs(history.torque_Nm))
    assert outcome.verdict == "named"
    assert [c.id for c in outcome.causes] == ["direction_asymmetry"]
    # compliances 10 ± 0.5 arcsec per N·m: −10 %, to what 960 rows of noise and the shapes leave
    assert outcome.causes[0].magnitude == pytest.approx(-10.0, abs=1.0)


def test_a_drift_is_named_beside_another_cause_though_the_room_warms_as_evenly() -> None:
    """A zero that follows the temperature explains it as well, and is no known cause."""
    time = TURNING.time_s
    assert time is not None
    share = (time - time[0]) / (time[-1] - time[0])
    place = 45.0 * TURNING.cycle
    warm = 20 + 10 * share + np.random.default_rng(5).normal(0, 0.03, len(share))
    history = replace(TURNING, temperature_C=warm, input_angle_deg=place)
    outcome = diagnosed(history, 8.0 * np.sin(np.radians(2 * place)) - 6.0 * share)
    assert outcome.verdict == "named"
    assert {c.id for c in outcome.causes} == {"kinematic_error", "sensor_drift"}
