"""The error on data held out: of which rows it is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from histories import PREDICTION, sweep

from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep

NOISE_ARCSEC = 0.5
CROSSED_OVER = 0.02
"""N·m over which the teeth go from flank to flank: 1 % of the largest torque, the band is 3.5 %."""


def test_rows_in_the_gap_s_crossing_are_left_out() -> None:
    """A gap of 60 arcsec, crossed smoothly: rows on the way are up to 30 arcsec off any sharp gap."""
    history = sweep(cycles=4, hold=0, rows=800)
    rng = np.random.default_rng(8)
    torque = history.torque_Nm
    side = np.tanh(torque / CROSSED_OVER)
    angle = 10.0 * torque + 30.0 * side + rng.normal(0, NOISE_ARCSEC, len(torque))
    record = Sweep(
        Path("rig.csv"), history, angle, ("",), ((1.0, 2.0, 3.0, 4.0),),
        np.arange(len(torque)) + 2, cycles_recorded=True,
    )  # fmt: skip
    outcome, behind = diagnose_sweep(record, PREDICTION)
    assert outcome.gain is not None
    assert behind is not None
    rows = np.array(outcome.gain.held_out_rows)
    assert np.abs(torque[rows]).min() > behind.explained.prepared.band_Nm
    # 370 rows: ± 4 %, thrice that
    assert outcome.gain.rmse_after == pytest.approx(NOISE_ARCSEC, rel=0.12)
