"""A torque that is read in coarse steps, and what its rounding may be taken for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from histories import sweep

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_step import torque_step_Nm
from flexspline.results.diagnosis.notes import notes

STEP_Nm = 0.05


def ramps(per_cycle: int) -> np.ndarray:
    """Five cycles of ± 10 N·m, rows of no whole number of steps."""
    i = np.arange(5 * per_cycle)
    return 10 * (1 - 4 * np.abs((i / per_cycle + 0.25) % 1 - 0.5))


@pytest.mark.parametrize("per_cycle", [203, 297, 41 * 4])
def test_the_step_of_a_rounded_torque(per_cycle: int) -> None:
    """Also where levels of the repeated programme are several steps apart."""
    torque = ramps(per_cycle)
    assert torque_step_Nm(History.course(np.round(torque / STEP_Nm) * STEP_Nm)) == pytest.approx(
        STEP_Nm
    )
    assert torque_step_Nm(History.course(torque)) == 0


def test_a_programme_s_own_steps_are_no_rounding() -> None:
    assert torque_step_Nm(sweep(cycles=5, rows=400, hold=0)) == 0


def test_a_saw_tooth_of_rounding_is_no_effect_of_the_torque(tmp_path: Path) -> None:
    torque = ramps(203)
    rng = np.random.default_rng(1)
    angle = 11.343 * torque + 36.1 * np.sign(torque) + rng.normal(0, 0.07, len(torque))
    read = np.round(torque / STEP_Nm) * STEP_Nm
    path = tmp_path / "rig.csv"
    rows = zip(np.arange(len(torque)), read, angle, strict=True)
    path.write_text(
        "time_s,torque_Nm,angle_arcsec\n" + "".join(f"{k},{t:.2f},{a:.4f}\n" for k, t, a in rows)
    )
    found = diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, 31329.0, 43339.0)
    assert found.verdict == "consistent"
    assert any("read in steps of 0.05 N·m" in n for n in notes(found))
