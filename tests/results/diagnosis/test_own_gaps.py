"""Units whose gaps differ: each has its own in a note, since `calibrated` holds the common one alone."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.results.diagnosis.notes import notes

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
COMPLIANCE = (1 / 31_300 + 1 / 43_300) * 206_264.8


def gap_note(gaps: tuple[float, ...], folder: Path) -> list[str]:
    rng, lines = np.random.default_rng(3), ["unit,cycle,time_s,torque_Nm,angle_arcsec"]
    one = 8 * np.interp(np.arange(200) / 200, [0, 0.25, 0.75, 1], [0, 1, -1, 0])
    for place, gap in enumerate(gaps):
        torque = np.tile(one, 4)
        angle = COMPLIANCE * torque + gap / 2 * np.sign(torque) + rng.normal(0, 0.4, len(torque))
        lines += [
            f"U{place + 1},{i // 200 + 1},{i},{t:.5f},{a:.3f}"
            for i, (t, a) in enumerate(zip(torque, angle, strict=True))
        ]
    path = folder / "units.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return [n for n in notes(diagnose_file(DESIGN, path, 31_300.0, 43_300.0)) if "each unit" in n]


def test_units_of_unlike_gaps_have_each_its_own(tmp_path: Path) -> None:
    (note,) = gap_note((40.0, 62.0), tmp_path)
    first, second, apart = (float(x) for x in re.findall(r"(\d+\.\d) arcsec", note))
    # 800 rows of 0.4 arcsec: 0.03; the rest of the gap is what C·T leaves by its own prior
    assert first == pytest.approx(40.0, abs=0.3)
    assert second == pytest.approx(62.0, abs=0.3)
    assert apart == pytest.approx(22.0, abs=0.2)


def test_a_single_unit_has_no_such_note(tmp_path: Path) -> None:
    assert gap_note((40.0,), tmp_path) == []
