"""A zero that follows the temperature: its size for each kelvin."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.prediction import prediction_of
from flexspline.results.diagnosis.notes import notes

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
K_b, K_e = 31_300.0, 44_000.0
LARGEST_Nm, ROWS, CYCLES, NOISE_arcsec = 10.0, 100, 10, 0.4
ZERO_arcsec_per_K = -0.8


def test_the_zero_s_change_is_said_for_each_kelvin(tmp_path: Path) -> None:
    prediction = prediction_of(DESIGN, K_b, K_e)
    n = ROWS * CYCLES
    torque = LARGEST_Nm * np.interp(np.arange(n) % ROWS / ROWS, [0, 0.25, 0.75, 1], [0, 1, -1, 0])
    temperature = 24 + 6 * np.sin(2 * np.pi * np.arange(n) / n * 1.7)
    angle = prediction.compliance * torque + prediction.gap_arcsec / 2 * np.sign(torque)
    angle += ZERO_arcsec_per_K * temperature
    angle += np.random.default_rng(3).normal(0, NOISE_arcsec, n)
    rows = enumerate(zip(torque, temperature, angle, strict=True))
    text = "".join(f"{i // ROWS + 1},{i},{t:.4f},{c:.2f},{a:.3f}\n" for i, (t, c, a) in rows)
    path = tmp_path / "m.csv"
    path.write_text("cycle,time_s,torque_Nm,temperature_C,angle_arcsec\n" + text, encoding="utf-8")
    said = " ".join(notes(diagnose_file(DESIGN, path, K_b, K_e)))
    size = re.search(r"the zero offset changes by −(\S+) arcsec/K", said)
    assert size is not None
    # 0.4 arcsec of noise in 1000 rows over 6 K: 0.004 arcsec/K; rounding to two decimals as much again
    assert float(size[1]) == pytest.approx(-ZERO_arcsec_per_K, abs=0.02)
