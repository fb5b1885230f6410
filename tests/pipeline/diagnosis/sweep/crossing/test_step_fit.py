"""Where the gap is crossed, before anything is fitted, whatever else a record holds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import LARGEST, sweep

from flexspline.pipeline.diagnosis.causes.micro_slip import POWER, micro_slips
from flexspline.pipeline.diagnosis.causes.operators import stops
from flexspline.pipeline.diagnosis.sweep.crossing.friction_ahead_guess import (
    COARSE_PLACES,
    FINE_PLACES,
    first_ahead,
)
from flexspline.pipeline.diagnosis.sweep.crossing.friction_ahead_guess import (
    LARGEST_FRICTION as MOST_FRICTION,
)
from flexspline.pipeline.diagnosis.sweep.crossing.gap_crossing import OFFSET_REACH
from flexspline.pipeline.diagnosis.sweep.crossing.step_fit import (
    StepFit,
    changing_heights,
    zeros_of_cycles,
)
from flexspline.pipeline.diagnosis.sweep.crossing.torque_offset_guess import (
    FIRST_STEPS,
    first_offset,
)

WHOLE = sweep(cycles=7, rows=200, hold=0)
HISTORY = replace(WHOLE, torque_Nm=WHOLE.torque_Nm * (1 - 0.3 * (WHOLE.cycle % 3)))
"""Each cycle at another position, at three amplitudes."""
GAP, BAND = 60.0, 0.05 * LARGEST
SOFTER = 0.3
"""Of the compliance, that swings twice in a turn: 240 arcsec at the largest torque, four times the gap."""


def angle(torque_Nm: np.ndarray) -> np.ndarray:
    """Of a torque at the teeth, with noise of 0.5 arcsec."""
    assert HISTORY.input_angle_deg is not None
    compliance = 400.0 * (1 + SOFTER * np.cos(np.radians(2 * HISTORY.input_angle_deg)))
    noise = np.random.default_rng(3).normal(0, 0.5, len(torque_Nm))
    return compliance * torque_Nm + GAP / 2 * np.sign(torque_Nm) + noise


@pytest.mark.parametrize("offset", [-0.2, 0.16])
def test_a_shifted_reading_is_seen_though_stiffness_differs_between_cycles(offset: float) -> None:
    read = replace(HISTORY, torque_Nm=HISTORY.torque_Nm + offset * LARGEST)
    found = first_offset(read, angle(HISTORY.torque_Nm), GAP, BAND)
    spacing = 2 * OFFSET_REACH * np.abs(read.torque_Nm).max() / (FIRST_STEPS - 1)
    # places tried are so far apart, and rows as far as 2 N·m in 50
    assert found == pytest.approx(offset * LARGEST, abs=spacing + LARGEST / 50)


@pytest.mark.parametrize("twist_arcsec", [2000.0, 4000.0])
def test_a_wide_rounded_loop_without_a_step_shows_no_shifted_reading(twist_arcsec: float) -> None:
    """Micro-slip by a power that no curve of the guess follows leaves less at one place than at another."""
    steady = replace(WHOLE, torque_Nm=WHOLE.torque_Nm * np.where(WHOLE.cycle == 0, 1.0, 0.75))
    slip = micro_slips(
        [{POWER: 3.2, "held": 1, "largest_torque_Nm": LARGEST, "deadband_Nm": 0.0}], steady
    )
    twist = 400.0 * steady.torque_Nm + twist_arcsec * slip[0][:, 0]
    assert first_offset(steady, twist, GAP, BAND) == 0.0


def test_friction_ahead_is_seen_though_stiffness_differs_between_cycles() -> None:
    friction = 0.15 * LARGEST
    carried = stops(HISTORY, HISTORY.torque_Nm, np.array([friction]), np.zeros(1))[:, 0]
    found = first_ahead(HISTORY, angle(HISTORY.torque_Nm - carried), GAP, BAND)
    assert found is not None
    fine = MOST_FRICTION * LARGEST / COARSE_PLACES / (FINE_PLACES + 1)
    assert found.friction_Nm == pytest.approx(friction, abs=fine + LARGEST / 50)


def test_a_shifted_reading_is_seen_though_the_zero_drifts() -> None:
    """By forty gaps over the record, six within a cycle."""
    offset = 0.16 * LARGEST
    assert HISTORY.time_s is not None
    drift = 40 * GAP * HISTORY.time_s / HISTORY.time_s[-1]
    read = replace(HISTORY, torque_Nm=HISTORY.torque_Nm + offset)
    found = first_offset(read, angle(HISTORY.torque_Nm) + drift, GAP, BAND)
    spacing = 2 * OFFSET_REACH * np.abs(read.torque_Nm).max() / (FIRST_STEPS - 1)
    assert found == pytest.approx(offset, abs=spacing + LARGEST / 50)


def test_a_step_that_follows_temperature_is_one_step() -> None:
    """A gap of 20 to 200 arcsec over the cycles, which no step of one height fits."""
    kelvin = HISTORY.temperature_C
    assert kelvin is not None
    gap = 20.0 + 180.0 * (kelvin - kelvin.min()) / np.ptp(kelvin)
    noise = np.random.default_rng(3).normal(0, 0.5, len(HISTORY))
    turned = gap / 2 * np.sign(HISTORY.torque_Nm) + noise
    smooth = np.column_stack([*zeros_of_cycles(HISTORY), HISTORY.torque_Nm])
    one = StepFit(smooth, turned, GAP, BAND).misfit(HISTORY.torque_Nm)
    changing = StepFit(smooth, turned, GAP, BAND, changing_heights(HISTORY))
    found = changing.misfit(HISTORY.torque_Nm)
    assert found == pytest.approx(
        0.25 * len(HISTORY), rel=0.1
    )  # the noise; rms good to 3 % of 1400 rows
    assert one > 100 * found
