"""The size of a twist where most rows of a record lie in holds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import PREDICTION, sweep

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.plausibility import slope_beyond
from flexspline.pipeline.diagnosis.sweep.twist_ratio import sweep_size

HELD = replace(sweep(cycles=4, rows=80, hold=150), temperature_C=None, input_angle_deg=None)
"""±2 N·m: ramps of 20 rows from zero, holds of 150: four rows of five lie in holds."""
LOOP = 6.0
"""Half width of a loop open on the ramps and closed in the holds: a lag's [arcsec]."""


def angle(history: History) -> np.ndarray:
    """A gear as simulated that lags: 10 arcsec/N·m, a gap of 60, and the loop while torque moves."""
    moving = np.sign(np.diff(history.torque_Nm, prepend=0.0))
    return 10.0 * history.torque_Nm + 30.0 * np.sign(history.torque_Nm) - LOOP * moving


def test_ramps_off_the_line_still_tell_slope_from_gap() -> None:
    rng = np.random.default_rng(1)
    # 0.01 N·m of torque noise are all the torque that varies in a hold
    read = replace(HELD, torque_Nm=HELD.torque_Nm + rng.normal(0, 0.01, len(HELD)))
    size = sweep_size(read, angle(HELD) + rng.normal(0, 0.3, len(HELD)), PREDICTION)
    assert size is not None
    # the loop is as often above as below; the ramps' ±2 N·m hold 20 arcsec, its first ramp has no fellow
    assert size.compliance == pytest.approx(1.0, abs=0.2)
    assert not slope_beyond(size, 10.0)


def test_single_spikes_are_no_part_of_the_line() -> None:
    spiked = angle(HELD) + np.random.default_rng(2).normal(0, 0.3, len(HELD))
    clean = sweep_size(HELD, spiked, PREDICTION)
    spiked[[5, 200, 431]] += 5000.0
    size = sweep_size(HELD, spiked, PREDICTION)
    assert clean is not None
    assert size is not None
    assert size.compliance == pytest.approx(clean.compliance, abs=0.01)
