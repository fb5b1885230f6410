"""Long records of a gear as simulated, read in steps of the encoder that are more than the noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
COMPLIANCE, GAP = 10.0235, 72.2
"""Of the design with K_b = 31 320 and K_e = 60 000 N·m/rad: arcsec per N·m, arcsec."""
ROWS, CYCLES = 20_001, 20


def record(folder: Path, more_arcsec: np.ndarray) -> Path:
    rng = np.random.default_rng(2)
    turn = np.arange(ROWS) * CYCLES / (ROWS - 1)
    torque = 40 * 2 / np.pi * np.arcsin(np.sin(2 * np.pi * turn))
    angle = COMPLIANCE * torque + GAP / 2 * np.sign(torque) + rng.normal(0, 0.15, ROWS)
    cycle = np.minimum(turn.astype(int), CYCLES - 1) + 1
    read = np.round(angle + more_arcsec + 3.3)
    path = folder / "coarse.csv"
    np.savetxt(
        path, np.column_stack([cycle, 60 * turn, torque, read]), delimiter=",",
        fmt=["%d", "%.3f", "%.4f", "%.0f"], header="cycle,time_s,torque_Nm,angle_arcsec", comments="",
    )  # fmt: skip
    return path


@pytest.mark.usefixtures("causes_only")
def test_what_rounding_leaves_is_no_effect(tmp_path: Path) -> None:
    found = diagnose_file(DESIGN, record(tmp_path, np.zeros(ROWS)), 31320, 60000)
    assert found.verdict == "consistent"


@pytest.mark.usefixtures("causes_only")
def test_what_is_more_than_rounding_is_seen(tmp_path: Path) -> None:
    """A wave of 0.8 arcsec in time, which no cause explains; rounding leaves 0.2 arcsec rms."""
    wave = 0.8 * np.sin(2 * np.pi * np.arange(ROWS) / 2173)
    found = diagnose_file(DESIGN, record(tmp_path, wave), 31320, 60000)
    assert found.verdict == "unknown"
