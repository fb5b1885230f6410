"""An encoder's steps are said where rounding is most of the noise; a file's last digits are no encoder."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.results.diagnosis.notes import notes

DESIGN = load_design(EXAMPLES / "xb1-40.toml")


@pytest.mark.parametrize(
    ("step_arcsec", "said"),
    [pytest.param(1.5, True, marks=pytest.mark.long), (0.1, True), (2e-4, False)],
)
def test_a_record_of_no_noise(step_arcsec: float, said: bool, tmp_path: Path) -> None:
    torque = np.tile(4 * np.sin(np.linspace(0, 2 * np.pi, 240, endpoint=False)), 3)
    twist = 15.3 * torque + 11.0 * np.sign(torque)
    read = step_arcsec * np.round(twist / step_arcsec)
    path = tmp_path / "sweep.csv"
    rows = (
        f"{i // 240 + 1},{i},{t:.9f},{a:.9f}\n"
        for i, (t, a) in enumerate(zip(torque, read, strict=True))
    )
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + "".join(rows), encoding="utf-8")
    found = diagnose_file(DESIGN, path, 31_300.0, 43_300.0)
    assert any("is read in steps of" in note for note in notes(found)) == said
