"""A gap that follows the temperature with a delay: a size that the record does not show is unsure."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import diagnose_file

CUP = Path(__file__).parents[3] / "examples" / "xb1-40.toml"
PER_KELVIN, DELAY_s, PERIOD_s = -0.6, 350.0, 2700.0


def test_lags_that_cancel_each_other_leave_the_size_less_sure(tmp_path: Path) -> None:
    """One frequency shows how far the gap moves at that frequency; at rest it moves by 0.6 arcsec/K. The race
    takes lags of opposite sign for the delay; the size was 3.5 of its deviations off."""
    share = np.concatenate([np.arange(50) / 50, 1 - np.arange(100) / 50, np.arange(50) / 50 - 1])
    torque = 10.0 * np.tile(share, 10)
    time = 3.0 * np.arange(len(torque))

    def warm(t: np.ndarray) -> np.ndarray:
        return 25.0 * np.sin(2 * np.pi * np.maximum(t, 0.0) / PERIOD_s)

    gap = 72.2 + PER_KELVIN * warm(time - DELAY_s)
    angle = 3.117 * torque + np.sign(torque) * gap / 2
    angle += np.random.default_rng(1).normal(0, 0.4, len(torque))
    record = tmp_path / "warm.csv"
    rows = zip(time, torque, 20 + warm(time), angle, strict=True)
    text = "".join(f"{t:g},{m:.4f},{c:.4f},{a:.4f}\n" for t, m, c, a in rows)
    record.write_text("time_s,torque_Nm,temperature_C,angle_arcsec\n" + text)
    (found,) = diagnose_file(load_design(CUP), record, 125_274.0, 140_291.0).causes
    assert found.id == "thermal_clearance"
    assert abs(found.magnitude - PER_KELVIN) < 2 * found.magnitude_std
