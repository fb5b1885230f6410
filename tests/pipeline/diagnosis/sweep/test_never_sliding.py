"""Friction whose twist is larger than its widest loop: what never slides is a spring."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design

COMPLIANCE, GAP_ARCSEC = 11.343, 72.2
SLOW, QUICK = (180.0, 2.0, 270), (20.0, 1.0, 30)
"""Of a sine: period [s], largest torque [N·m], rows."""


def record(seed: int) -> str:
    """A gear of 0.8 of the simulated compliance, and a ripple of 57 arcsec over its output angle."""
    rng = np.random.default_rng(seed)
    rows, start = [], 0.0
    for cycle in range(6):
        period, largest, count = (SLOW, QUICK)[cycle % 2]
        t = (np.arange(count) + 1) * period / count
        torque = largest * np.sin(2 * np.pi * t / period)
        rows.append(np.c_[np.full(count, cycle), start + t, torque])
        start += period
    cycle, time, torque = np.vstack(rows).T
    twist = 0.8 * COMPLIANCE * torque + np.sign(np.round(torque, 9)) * GAP_ARCSEC / 2
    noise = rng.normal(0, 0.29, len(torque))
    for i in range(1, len(noise)):
        noise[i] = 0.6 * noise[i - 1] + 0.8 * noise[i]
    angle = twist + 1.85 * np.sin(2 * np.pi * twist / 56.5915) + noise
    read = torque + rng.normal(0, 0.001, len(torque))
    body = zip(cycle, time, read, angle, strict=True)
    lines = "".join(f"{c:.0f},{t:.2f},{m:.5f},{a:.2f}\n" for c, t, m, a in body)
    return "cycle,time_s,torque_Nm,angle_arcsec\n" + lines


@pytest.mark.usefixtures("causes_only")
def test_friction_of_more_twist_than_loop_is_not_alone(tmp_path: Path) -> None:
    """A loop of 0.29 arcsec was named with certainty beside a twist of 2.1 arcsec rms."""
    path = tmp_path / "rig.csv"
    path.write_text(record(8))
    told = diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, 31313.5, 43275.0)
    friction = [c for c in told.outcome.causes if c.id == "friction_hysteresis"]
    assert all("series_compliance" in c.alternatives for c in friction)
    assert told.outcome.verdict != "named"
