"""Noise of the race: slow noise is no effect, and an effect that rows hardly follow is no noise."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from histories import PREDICTION, sweep

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep, run_race

TURNING = replace(sweep(cycles=8, rows=200, hold=0), temperature_C=None, input_angle_deg=None)
SPARSE = replace(sweep(cycles=8, rows=24, hold=24), temperature_C=None, input_angle_deg=None)
"""Ramps of six rows from zero between holds of 24: a parabola over seven rows holds corners."""


def raced(history: History, added: np.ndarray) -> ExplainedSweep:
    angle = 10.0 * history.torque_Nm + 30.0 * np.sign(history.torque_Nm) + added
    record = Sweep(
        Path("rig.csv"), history, angle, ("",), (tuple(np.unique(history.cycle) + 1.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip
    return run_race(prepare(record, PREDICTION))


@pytest.mark.parametrize("seed", range(4))
def test_slow_noise_is_no_effect(seed: int) -> None:
    """White noise through a lag of 14 rows, of a cycle of 200; as much beside it as white noise."""
    rng, keep = np.random.default_rng(seed), np.exp(-1 / 14)
    out = np.zeros(len(TURNING))
    for k in range(1, len(out)):
        out[k] = keep * out[k - 1] + rng.normal() * np.sqrt(1 - keep**2)
    found = raced(TURNING, 0.4 * out + rng.normal(0, 0.4, len(out)))
    assert found.identified.named == ()
    noise = found.prepared.noise
    # 1600 rows hold 57 pieces of 2τ: a third on the slow power, by the 2 deviations of a test of four
    assert np.log(noise.slow_power) == pytest.approx(np.log(0.16 + 0.16 * 28), abs=2 / 3)


def test_an_effect_that_rows_hardly_follow_is_no_noise() -> None:
    """A twist that lags by 5 arcsec while torque moves, and not in the holds."""
    moving = np.sign(np.diff(SPARSE.torque_Nm, prepend=0.0))
    noise = np.random.default_rng(5).normal(0, 0.2, len(moving))
    found = raced(SPARSE, -5.0 * moving + noise)
    # beside the white noise of 0.2 what the lag's shape misses in the rows of its corners
    assert found.prepared.noise.std_arcsec < 0.4
