"""A gap that differs from cycle to cycle: the calibrated one is their mean, and a note says so."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.results.diagnosis.notes import notes

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
COMPLIANCE = (1 / 31_300 + 1 / 43_300) * 206_264.8
ROWS, NOISE = 120, 0.3
"""Of a cycle; arcsec."""


def diagnosed(gaps: tuple[float, ...], folder: Path) -> Diagnosis:
    rng, lines = np.random.default_rng(4), ["cycle,time_s,torque_Nm,angle_arcsec"]
    torque = 8 * np.sin(2 * np.pi * (np.arange(ROWS) + 0.5) / ROWS)
    for number, gap in enumerate(gaps):
        angle = COMPLIANCE * torque + gap / 2 * np.sign(torque) + rng.normal(0, NOISE, ROWS)
        lines += [
            f"{number + 1},{number * ROWS + i},{t:.5f},{a:.3f}"
            for i, (t, a) in enumerate(zip(torque, angle, strict=True))
        ]
    path = folder / "cycles.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return diagnose_file(DESIGN, path, 31_300.0, 43_300.0)


@pytest.mark.parametrize(
    "gaps",
    [
        (71.0, 66.0, 80.0, 62.0, 75.0, 68.0),
        (58.0, 52.0, 67.0, 49.0, 61.0),
        (50.0, 64.0, 58.0, 66.0, 52.0, 61.0),
        (66.0, 69.0, 65.0, 68.0, 70.5, 67.5, 64.0),
        (90.0, 70.0, 88.0, 74.0, 71.0),
    ],
)
def test_gaps_of_cycles_have_their_mean_and_their_spread(
    gaps: tuple[float, ...], tmp_path: Path
) -> None:
    found = diagnosed(gaps, tmp_path)
    mean, std = float(np.mean(gaps)), float(np.std(gaps, ddof=1))
    # of 240 rows and more, of 0.3 arcsec: 0.04; three deviations
    assert found.calibration is not None
    assert found.calibration.gap_arcsec.value == pytest.approx(mean, abs=0.2)
    (note,) = [n for n in notes(found) if "separate gap in each cycle" in n]
    said = [float(x) for x in re.findall(r"\d+\.\d", note)]
    # of 60 rows each in half of a cycle; and a digit after the point
    assert said == pytest.approx([mean, min(gaps), max(gaps), std], abs=0.35)


def test_beside_wear_it_is_that_of_the_start(tmp_path: Path) -> None:
    found = diagnosed((60.0, 63.0, 66.0, 69.0, 72.0, 75.0), tmp_path)
    assert [c.id for c in found.causes] == ["wear"]
    assert found.calibration is not None
    assert found.calibration.gap_arcsec.value == pytest.approx(60.0, abs=0.3)
    assert any("the calibrated gap is that at the start of the record" in n for n in notes(found))


def test_one_gap_has_no_such_note(tmp_path: Path) -> None:
    assert not [n for n in notes(diagnosed((70.0,) * 4, tmp_path)) if "calibrated gap" in n]
