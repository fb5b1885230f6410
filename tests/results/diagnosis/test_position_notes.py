"""A damaged place of the wave generator's turn, each cycle at its own angle."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.prediction import prediction_of
from flexspline.results.diagnosis.notes import notes

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
K_b, K_e = 31_300.0, 44_000.0
LARGEST_Nm, ROWS, CYCLES, STEP_deg, NOISE_arcsec = 10.0, 64, 24, 15, 0.4


def diagnosed(path: Path, damaged: tuple[int, ...], deep_arcsec: float) -> Diagnosis:
    """Each cycle at the next angle; at the damaged ones the twist of one direction is larger."""
    prediction = prediction_of(DESIGN, K_b, K_e)
    share = np.tile(np.interp(np.arange(ROWS) / ROWS, [0, 0.25, 0.75, 1], [0, 1, -1, 0]), CYCLES)
    torque, place = LARGEST_Nm * share, STEP_deg * (np.arange(CYCLES * ROWS) // ROWS)
    angle = prediction.compliance * torque + prediction.gap_arcsec / 2 * np.sign(torque)
    angle += deep_arcsec * np.isin(place, damaged) * np.clip(share, 0, None)
    angle += np.random.default_rng(5).normal(0, NOISE_arcsec, len(torque))
    rows = enumerate(zip(place, torque, angle, strict=True))
    text = "".join(f"{i},{p},{t:.4f},{a:.3f}\n" for i, (p, t, a) in rows)
    path.write_text("time_s,input_angle_deg,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    return diagnose_file(DESIGN, path, K_b, K_e)


def test_the_angles_where_the_residual_stands_out_are_named(tmp_path: Path) -> None:
    said = " ".join(notes(diagnosed(tmp_path / "a.csv", (195, 210), 12.0)))
    assert "is large at the wave generator's angle of 195° and 210°" in said


def test_a_sound_gear_has_no_such_angle(tmp_path: Path) -> None:
    assert "is large" not in " ".join(notes(diagnosed(tmp_path / "a.csv", (), 0.0)))
