"""What an encoder's rounding leaves open, where no noise dithers it: every cycle is rounded alike."""

from __future__ import annotations

import numpy as np
import pytest
from histories import PREDICTION
from read_sweep import as_read, history_of, steps

from flexspline.pipeline.diagnosis.measurement.encoder_step import common_step
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.sweep.race.race import run_race

LARGEST_Nm, STEP = 20.0, 4.0
CYCLES = 6


def rounded(each_quarter: int, seed: int, noise: float) -> tuple[Sweep, float, float]:
    """A record read in steps of STEP with noise in steps, and its true gap and compliance."""
    rng = np.random.default_rng(seed)
    history = history_of(steps(LARGEST_Nm, each_quarter), CYCLES)
    compliance = PREDICTION.compliance + rng.normal(0, 0.1)
    gap = PREDICTION.gap_arcsec + rng.normal(0, 3.0)
    angle = compliance * history.torque_Nm + gap / 2 * history.sign + rng.uniform(-STEP, STEP)
    angle += STEP * noise * rng.normal(0, 1, len(history))
    return as_read(history, STEP * np.round(angle / STEP)), gap, compliance


@pytest.mark.parametrize("each_quarter", [20, 25, 50])
@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_gap_and_compliance_are_within_what_is_stated(each_quarter: int, noise: float) -> None:
    """Torque in steps of whole encoder steps: without noise all readings of a branch are rounded alike."""
    off = []
    for seed in range(3):
        sweep, gap, compliance = rounded(each_quarter, seed, noise)
        found = calibration_of(run_race(prepare(sweep, PREDICTION)))
        assert found.compliance is not None
        off.append((found.gap_arcsec.value - gap) / found.gap_arcsec.std)
        off.append((found.compliance.value - compliance) / found.compliance.std)
    # of errors that are even between two limits, none is beyond √3 deviations; noise adds to them
    assert np.abs(off).max() < 3


def test_what_noise_dithers_is_not_doubted() -> None:
    """Noise of half a step: of n rows, a gap has twice the noise over √n, and rounding none of it."""
    sweep, _, _ = rounded(50, 1, 0.5)
    found = calibration_of(run_race(prepare(sweep, PREDICTION)))
    # torque even over its range: gap and compliance share what is known, and each has 2 times the deviation
    alone = 2 * 2 * np.hypot(0.5, 12**-0.5) * STEP / len(sweep.angle_arcsec) ** 0.5
    assert found.gap_arcsec.std < 1.5 * alone


def test_few_readings_show_the_step_that_is_common_to_them() -> None:
    assert common_step(np.array([0.0, 40.0, 96.0, 136.0])) == 8.0
    assert common_step(np.array([1.5, 1.5])) == 0.0
    assert common_step(np.array([0.0, 0.1234, 0.3])) == pytest.approx(0.0002)
