"""Records of many rows with 1 % of torque noise, as a load cell beside a motor makes them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis

K_B, K_E = 31_377.0, 43_275.0
COMPLIANCE = 648_000 / np.pi * (1 / K_B + 1 / K_E)
GAP, LARGEST, NOISE, ANGLE_NOISE = 30.0, 40.0, 0.4, 0.3
"""arcsec, N·m, N·m, arcsec: the noise of the torque makes 15 times as much of the angle as its own."""
CORNERS = {
    "triangle": ([0, 0.25, 0.75, 1], [0, 1, -1, 0]),
    "rests": ([0, 0.2, 0.3, 0.7, 0.8, 1], [0, 1, 1, -1, -1, 0]),
    "rests at zero": ([0, 0.2, 0.25, 0.45, 0.55, 0.75, 0.8, 1], [0, 1, 1, 0, 0, -1, -1, 0]),
}


def diagnosed(
    folder: Path, programme: str, rows: int, seed: int, hardening: float = 0.0
) -> Diagnosis:
    """Of a gear without any effect, or one whose twist falls behind by a share at the largest torque."""
    turn = np.arange(rows) * 4 / rows
    share = (
        np.sin(2 * np.pi * turn)
        if programme == "sine"
        else np.interp(turn % 1, *CORNERS[programme])
    )
    torque, rng = LARGEST * share, np.random.default_rng(seed)
    angle = COMPLIANCE * LARGEST * (share - hardening * np.sign(share) * share**2)
    angle += GAP / 2 * np.sign(share) + ANGLE_NOISE * rng.normal(size=rows)
    read = torque + NOISE * rng.normal(size=rows)
    csv = folder / "measured.csv"
    np.savetxt(
        csv, np.column_stack([0.1 * np.arange(rows), read, angle, turn.astype(int)]),
        delimiter=",", header="time_s,torque_Nm,angle_arcsec,cycle", comments="", fmt="%.6g",
    )  # fmt: skip
    return diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), csv, K_B, K_E)


@pytest.mark.parametrize(
    ("programme", "rows"),
    [
        pytest.param("triangle", 6000, marks=pytest.mark.long),
        pytest.param("sine", 6000, marks=pytest.mark.long),
        ("rests at zero", 20_000),
        pytest.param("triangle", 36_000, marks=pytest.mark.long),
    ],
)
def test_a_gear_without_effects_is_told_so(tmp_path: Path, programme: str, rows: int) -> None:
    """The gap by a straight line of 700 readings on either side of each crossing: to about 0.1 arcsec."""
    found = diagnosed(tmp_path, programme, rows, 5)
    assert found.verdict == "consistent"
    assert found.calibration is not None
    gap = found.calibration.gap_arcsec
    assert gap.std < 0.25
    assert abs(gap.value - GAP) < 3 * gap.std


@pytest.mark.parametrize(
    ("programme", "rows"), [("sine", 2000), pytest.param("rests", 6000, marks=pytest.mark.long)]
)
def test_hardening_is_found_beside_it(tmp_path: Path, programme: str, rows: int) -> None:
    """The torque's own noise would make a curve of the reading less like the gear's than of the torque."""
    found = diagnosed(tmp_path, programme, rows, 5, hardening=0.06)
    assert found.verdict == "named"
    assert [c.id for c in found.outcome.causes] == ["stiffness_hardening"]
