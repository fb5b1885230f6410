"""A shifted torque reading on a rig that rests without torque between its cycles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design

COMPLIANCE, GAP_ARCSEC, LARGEST_Nm, NOISE_Nm = 11.343, 72.2, 5.0, 0.01
AMPLITUDES = (1.0, 0.5, 0.75, 1.0)
"""Of the cycles, over the largest torque. Each goes through zero at another row."""


def record(offset_Nm: float, side: float, seed: int) -> str:
    """Sines of 100 rows, each followed by 33 rows at zero torque with the output at one side of its gap."""
    rng = np.random.default_rng(seed)
    phase = 2 * np.pi * (np.arange(100) + 0.5) / 100
    torque = np.concatenate(
        [np.r_[LARGEST_Nm * a * np.sin(phase), np.zeros(33)] for a in AMPLITUDES]
    )
    sides = np.where(torque == 0, side, np.sign(torque))
    angle = COMPLIANCE * torque + sides * GAP_ARCSEC / 2 + rng.normal(0, 0.25, len(torque))
    read = torque + offset_Nm + rng.normal(0, NOISE_Nm, len(torque))
    cycle = np.repeat(np.arange(len(AMPLITUDES)), 133)
    rows = zip(cycle, 0.9 * np.arange(len(torque)), read, angle, strict=True)
    body = "".join(f"{c},{t:.1f},{m:.4f},{a:.3f}\n" for c, t, m, a in rows)
    return "cycle,time_s,torque_Nm,angle_arcsec\n" + body


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(("offset_Nm", "side"), [(-0.15, -1), (0.26, -1), (0.26, 1), (-0.3, -1)])
def test_rows_of_a_rest_are_one_row_of_the_crossing(
    tmp_path: Path, offset_Nm: float, side: float
) -> None:
    """All rows lie on one side of the gap: the place was set beyond all of them, by 4 to 9 deviations."""
    path = tmp_path / "rig.csv"
    path.write_text(record(offset_Nm, side, 7))
    told = diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, 31313.5, 43275.0)
    (found,) = told.outcome.causes
    assert found.id == "torque_offset"
    assert found.magnitude_std < 0.025  # between a rest and the next row lie 0.08 N·m, 0.023 rms
    assert found.magnitude == pytest.approx(offset_Nm, abs=2 * found.magnitude_std)


def rows_at_zero(offset_Nm: float, seed: int) -> str:
    """Eighteen sines of 50 rows, every 25th without torque: there the output stays where it was."""
    rng = np.random.default_rng(seed)
    k = np.arange(1, 901)
    torque = 12.0 * np.sin(2 * np.pi * k / 50)
    sides = np.sign(np.round(torque, 9))
    sides[sides == 0] = sides[np.flatnonzero(sides == 0) - 1]
    angle = COMPLIANCE * torque + sides * GAP_ARCSEC / 2 + rng.normal(0, 0.41, len(k))
    read = torque + offset_Nm + rng.normal(0, 0.024, len(k))
    rows = zip((k - 1) // 50, 3.6 * k, read, angle, strict=True)
    body = "".join(f"{c},{t:.1f},{m:.5f},{a:.2f}\n" for c, t, m, a in rows)
    return "cycle,time_s,torque_Nm,angle_arcsec\n" + body


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize("seed", [1, 3])
def test_rows_at_zero_torque_are_no_friction_ahead_of_the_gap(tmp_path: Path, seed: int) -> None:
    """They lie late both ways: friction of 0.17 ± 0.30 and 0.41 ± 0.52 N·m was named with certainty."""
    path = tmp_path / "rig.csv"
    path.write_text(rows_at_zero(-0.165, seed))
    told = diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, 31313.5, 43275.0)
    (found,) = told.outcome.causes
    assert found.id == "torque_offset"
    assert found.magnitude == pytest.approx(-0.165, abs=2 * found.magnitude_std)
