"""A moving zero of the torque cell drifts the angle and the gap's crossing; a drifting angle only itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import LARGEST, PREDICTION, sweep
from read_sweep import as_read

from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.results.diagnosis.advice import why

pytestmark = pytest.mark.usefixtures("causes_only")

NOISE = 0.5  # arcsec
GEAR = replace(sweep(cycles=5, rows=240, hold=0), temperature_C=None, input_angle_deg=None)
MOVED_Nm = 0.04 * LARGEST


@pytest.mark.parametrize("seed", [1, 3, pytest.param(2, marks=pytest.mark.long)])
@pytest.mark.parametrize(("of_torque", "rivals"), [(True, ("torque_offset",)), (False, ())])
def test_where_the_gap_is_crossed_tells_whose_zero_moves(
    of_torque: bool, rivals: tuple[str, ...], seed: int
) -> None:
    """The same twist but near the gap: −compliance·zero."""
    assert GEAR.time_s is not None
    zero_Nm = MOVED_Nm * GEAR.time_s / GEAR.time_s[-1]
    read = replace(GEAR, torque_Nm=GEAR.torque_Nm + zero_Nm) if of_torque else GEAR
    angle = PREDICTION.angle_arcsec(GEAR)
    if not of_torque:
        angle = angle - PREDICTION.compliance * zero_Nm
    angle = angle + np.random.default_rng(seed).normal(0, NOISE, len(angle))
    found = diagnose_sweep(as_read(read, angle), PREDICTION)[0]
    drift = next(c for c in found.causes if c.id == "sensor_drift")
    assert drift.alternatives == rivals
    assert found.next_measurement is not None
    assert ("torque cell" in why(found.next_measurement, "sweep")) == of_torque
