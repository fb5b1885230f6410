"""Records of several units, one of which has next to no rows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

import flexspline

pytestmark = pytest.mark.usefixtures("causes_only")

DESIGN = flexspline.load_design(EXAMPLES / "xb1-40.toml")


@pytest.mark.parametrize("rows", [1, 2])
def test_a_unit_of_a_row_or_two_is_no_error(rows: int, tmp_path: Path) -> None:
    """A trapezoid, whose corners may ring: their period was sought between a single unit's own rows."""
    share = np.interp(np.arange(960) % 240, [0, 50, 70, 170, 190, 239], [0, 1, 1, -1, -1, 0])
    torque = 2.0 * share
    angle = 11.4 * torque + 36 * np.sign(torque) + np.random.default_rng(3).normal(0, 0.3, 960)
    lines = [
        f"a,{i},{i // 240 + 1},{t:.4f},{y:.3f}"
        for i, (t, y) in enumerate(zip(torque, angle, strict=True))
    ]
    lines += [f"b,{i},1,{1.0 + i},{47.0 + 11 * i}" for i in range(rows)]
    path = tmp_path / "m.csv"
    path.write_text(
        "\n".join(["unit,time_s,cycle,torque_Nm,angle_arcsec", *lines]) + "\n", encoding="utf-8"
    )
    assert diagnose_file(DESIGN, path, 31377, 43275).verdict == "consistent"
