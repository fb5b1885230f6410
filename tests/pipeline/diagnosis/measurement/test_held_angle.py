"""An angle that is read more slowly than rows are written; what holds still for other reasons is no such."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.results.diagnosis.data_used import data_record
from flexspline.results.diagnosis.notes import notes

ROWS, PER_CYCLE = 1200, 240
NUMBER = np.arange(ROWS)
RAMPS = 10 * (1 - 4 * np.abs(((NUMBER + 0.5) / PER_CYCLE + 0.25) % 1 - 0.5))
STAIRS = np.round(RAMPS[NUMBER // 5 * 5])
"""Five rows at each torque."""


def line(torque: np.ndarray) -> np.ndarray:
    """The simulated gear."""
    return 11.343 * torque + 36.1 * np.sign(torque)


def every(count: int) -> Callable[[np.ndarray], np.ndarray]:
    return lambda angle: angle[NUMBER // count * count]


def diagnosed(torque: np.ndarray, read: Callable, folder: Path, torque_noise: float) -> Diagnosis:
    rng = np.random.default_rng(0)
    angle = read(line(torque) + rng.normal(0, 0.5, ROWS))
    reading = torque + rng.normal(0, torque_noise, ROWS)
    path = folder / "rig.csv"
    body = "".join(f"{k},{t:.4f},{a:.3f}\n" for k, t, a in zip(NUMBER, reading, angle, strict=True))
    path.write_text("time_s,torque_Nm,angle_arcsec\n" + body)
    return diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, 31329.0, 43339.0)


@pytest.mark.parametrize("count", [2, 3])
def test_a_clean_gear_read_slowly_is_consistent(count: int, tmp_path: Path) -> None:
    found = diagnosed(RAMPS, every(count), tmp_path, 0.02)
    assert found.verdict == "consistent"
    held = ROWS - ROWS // count
    assert any(f"{held} rows that repeat the previous" in n for n in notes(found))
    rows = data_record(found)["rows"]
    assert rows["left_out"]["held_reading"] == held
    assert rows["read"] == ROWS == rows["used"] + sum(rows["left_out"].values())


def coarse(angle: np.ndarray) -> np.ndarray:
    """Steps of 5 arcsec, of which torque passes one in four rows."""
    return np.round(angle / 5) * 5


@pytest.mark.parametrize(
    ("torque", "read", "noise"),
    [
        (RAMPS, lambda angle: angle, 0.02),
        pytest.param(RAMPS / 8, coarse, 0.02, marks=pytest.mark.long),
        # the angle of a programme that was computed and not measured
        (STAIRS, lambda angle: line(STAIRS), 0.02),
    ],
)
def test_other_repeated_readings_stay(
    torque: np.ndarray, read: Callable, noise: float, tmp_path: Path
) -> None:
    found = diagnosed(torque, read, tmp_path, noise)
    assert found.measurement.held_rows == 0
