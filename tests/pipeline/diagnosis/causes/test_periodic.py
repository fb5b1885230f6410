"""Position errors of other waves than one, two and four a turn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

import flexspline

pytestmark = pytest.mark.usefixtures("causes_only")

DESIGN = flexspline.load_design(EXAMPLES / "xb1-40.toml")


@pytest.mark.parametrize("waves", [{3: 4.0}, {1: 4.0, 3: 1.5}, {5: 4.0}, {2: 3.0, 6: 1.0}], ids=str)
def test_a_position_error_of_these_waves_is_named(waves: dict[int, float], tmp_path: Path) -> None:
    """At 16 positions over the turn, as a tester takes them."""
    rng = np.random.default_rng(6)
    rows, positions = 100, 16
    torque = np.tile(2.0 * np.interp(np.arange(rows), [0, 25, 75, 99], [0, 1, -1, 0]), positions)
    cycle = np.repeat(np.arange(positions), rows)
    place = 22.5 * (7 * cycle % positions)  # not in order: time would pass for it
    error = sum(a * np.cos(n * np.radians(place) + n) for n, a in waves.items())
    angle = 11.35 * torque + 36 * np.sign(torque) + error + rng.normal(0, 0.3, len(torque))
    lines = [
        f"{5 * i},{cycle[i] + 1},{place[i]},{torque[i]:.4f},{angle[i]:.3f}"
        for i in range(len(torque))
    ]
    path = tmp_path / "m.csv"
    head = "time_s,cycle,input_angle_deg,torque_Nm,angle_arcsec"
    path.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")
    outcome = diagnose_file(DESIGN, path, 31312, 43275).outcome
    assert outcome.verdict == "named"
    (cause,) = outcome.causes
    assert cause.id == "kinematic_error"
    assert abs(cause.magnitude - max(waves.values())) < 3 * cause.magnitude_std
