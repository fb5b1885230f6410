"""Friction ahead of the gap, where the rig never holds the torque: at the teeth it rests after each turn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design

COMPLIANCE, GAP_ARCSEC, LARGEST_Nm, PER_CYCLE, CYCLES = 11.343, 72.2, 12.0, 240, 4


def record(friction_Nm: float, noise_arcsec: float, seed: int) -> str:
    """Triangles from zero, of which a play operator carries its friction ahead of a sharp gap."""
    rng = np.random.default_rng(seed)
    i = np.arange(PER_CYCLE * CYCLES)
    torque = LARGEST_Nm * (1 - 4 * np.abs((i / PER_CYCLE + 0.25) % 1 - 0.5))
    at_teeth, teeth = np.empty(len(torque)), 0.0
    for k, own in enumerate(torque):
        teeth = min(max(teeth, own - friction_Nm), own + friction_Nm)
        at_teeth[k] = teeth
    angle = COMPLIANCE * at_teeth + np.sign(at_teeth) * GAP_ARCSEC / 2
    angle += rng.normal(0, noise_arcsec, len(torque))
    read = torque + rng.normal(0, 0.01, len(torque))
    rows = zip(i // PER_CYCLE, 0.5 * i, read, angle, strict=True)
    body = "".join(f"{c},{t:.1f},{m:.4f},{a:.3f}\n" for c, t, m, a in rows)
    return "cycle,time_s,torque_Nm,angle_arcsec\n" + body


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(
    ("friction_Nm", "noise_arcsec", "seed"), [(0.8, 0.2, 3), (0.8, 0.4, 3), (0.5, 0.2, 2)]
)
def test_no_creep_is_named_of_what_no_hold_shows(
    tmp_path: Path, friction_Nm: float, noise_arcsec: float, seed: int
) -> None:
    path = tmp_path / "rig.csv"
    path.write_text(record(friction_Nm, noise_arcsec, seed))
    told = diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, 31313.5, 43275.0)
    assert told.outcome.verdict == "named"
    (found,) = told.outcome.causes
    assert found.id == "friction_hysteresis"
    wide = 2 * friction_Nm * COMPLIANCE
    assert found.magnitude == pytest.approx(wide, abs=2 * found.magnitude_std)
