"""What an extended model adds between −T_L and +T_L, by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest
from histories import shape_of

from flexspline.pipeline.backlash import Backlash
from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.model.extended_backlash import extended_backlash
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel

NOMINAL = Backlash(5.0, 6.0, 30.0, 40.0, 81.0, 12.0, {}, 0.0, None)
SIMULATED = ExtendedModel(11.0, 70.0, {"": 0.0}, {}, {})
"""At 0.5 N·m: 2·0.5·11 + 70 = 81."""


def added(cause: str, shape: dict, *amplitudes: float) -> float:
    model = replace(SIMULATED, elements={cause: (Element(shape, amplitudes),)})
    return extended_backlash(NOMINAL, model, 0.5).causes_arcsec[cause]


def test_a_model_that_is_the_simulation_adds_nothing() -> None:
    found = extended_backlash(NOMINAL, SIMULATED, 0.5)
    assert found.calibration_arcsec == pytest.approx(0.0, abs=1e-12)
    assert found.total_arcsec == pytest.approx(81.0)


def test_calibration_is_the_change_of_compliance_and_gap() -> None:
    model = replace(
        SIMULATED, compliance=12.0, gap_arcsec=66.0, own={"a": (1.0, 0), "b": (3.0, 4.0)}
    )
    found = extended_backlash(NOMINAL, model, 0.5)
    assert found.calibration_arcsec == pytest.approx(1.0 - 4.0 + 2.0 + 2.0)


def test_terms_of_causes() -> None:
    assert added("series_compliance", {}, 3.0) == pytest.approx(3.0)  # 2·0.5·3
    assert added("clearance_offset", {}, -7.0) == pytest.approx(-7.0)
    slider = shape_of(
        "friction_hysteresis",
        threshold_Nm=0.1,
        spread=0,
        loaded=0,
        held=1,
        start=0,
        deadband_Nm=0.0,
    )
    # friction takes 2 arcsec of the way at either end
    assert added("friction_hysteresis", slider, 2.0) == pytest.approx(-4.0)
    # one that does not slip below T_L is a spring: 0.5/2 of its threshold, at either end
    slider["threshold_Nm"] = 2.0
    assert added("friction_hysteresis", slider, 2.0) == pytest.approx(-2 * 2.0 * 0.5 / 2.0)


def test_what_is_in_the_readings_adds_nothing() -> None:
    drift = shape_of("sensor_drift", exponent=1.0, settling_s=0.0, duration_s=3600.0)
    assert added("sensor_drift", drift, 50.0) == pytest.approx(0.0, abs=1e-9)
    assert added("kinematic_error", shape_of("kinematic_error"), 5.0, 5.0) == pytest.approx(
        0.0, abs=1e-9
    )
    assert added("torque_offset", {}, 0.2) == 0.0
    warm = shape_of("thermal_clearance", lag_s=0.0)
    assert added("thermal_clearance", warm, -0.4) == pytest.approx(0.0, abs=1e-12)  # at 20 °C


def test_slow_ramps_leave_little_of_a_lag() -> None:
    """Ramps of ten minutes to 0.5 N·m: a rate of 1/1200 N·m/s, its shift at both ends."""
    shape = shape_of(
        "rate_dependence", lag_s=2.0, exponent=1.0, rate_Nm_per_s=1.0, ramp_s=10.0, deadband_Nm=0.0
    )
    assert added("rate_dependence", shape, 30.0) == pytest.approx(-2 * 30.0 / 1200, rel=0.01)
