"""Sizes that are means or shares: of what, and whether the rate stays."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.prediction import prediction_of
from flexspline.results.diagnosis.notes import notes

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
K_b, K_e = 31_300.0, 44_000.0
LARGEST_Nm, ROWS, CYCLES, NOISE_arcsec, GROWN_arcsec = 10.0, 100, 12, 0.4, 20.0


def worn(path: Path, share: np.ndarray) -> Diagnosis:
    """Of a gap that is wider in each cycle by a share (CYCLES,) of 20 arcsec."""
    prediction = prediction_of(DESIGN, K_b, K_e)
    n = ROWS * CYCLES
    torque = LARGEST_Nm * np.interp(np.arange(n) % ROWS / ROWS, [0, 0.25, 0.75, 1], [0, 1, -1, 0])
    gap = prediction.gap_arcsec + GROWN_arcsec * np.repeat(share, ROWS)
    angle = prediction.compliance * torque + gap / 2 * np.sign(torque)
    angle += np.random.default_rng(3).normal(0, NOISE_arcsec, n)
    rows = enumerate(zip(torque, angle, strict=True))
    text = "".join(f"{i // ROWS + 1},{i},{t:.4f},{a:.3f}\n" for i, (t, a) in rows)
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    found = diagnose_file(DESIGN, path, K_b, K_e)
    assert "wear" in [c.id for c in found.causes]
    return found


def test_wear_that_levels_off_is_said_to_have_a_mean_rate(tmp_path: Path) -> None:
    cycle = np.arange(CYCLES)
    said = " ".join(notes(worn(tmp_path / "a.csv", 1 - np.exp(-cycle / 2.0))))
    assert "mean over the record; the growth levels off" in said


def test_steady_wear_needs_no_such_word(tmp_path: Path) -> None:
    said = " ".join(notes(worn(tmp_path / "a.csv", np.arange(CYCLES) / (CYCLES - 1))))
    assert "the growth" not in said


def drifted(path: Path, share: np.ndarray, grown_arcsec: float, seed: int) -> list[str]:
    """What is said of how a zero goes on drifting, by a share (n,) of so much; the noise remembers a row."""
    prediction = prediction_of(DESIGN, K_b, K_e)
    n, rng = len(share), np.random.default_rng(seed)
    torque = LARGEST_Nm * np.sin(2 * np.pi * np.arange(n) / ROWS)
    angle = prediction.compliance * torque + prediction.gap_arcsec / 2 * np.sign(torque)
    noise = rng.normal(0, NOISE_arcsec, n)
    angle += grown_arcsec * share + noise + 0.5 * np.roll(noise, 1)
    rows = enumerate(zip(torque, angle, strict=True))
    text = "".join(f"{i // ROWS + 1},{i},{t:.4f},{a:.3f}\n" for i, (t, a) in rows)
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    found = diagnose_file(DESIGN, path, K_b, K_e)
    assert [c.id for c in found.causes] == ["sensor_drift"]
    return [n for n in notes(found) if "mean over the record" in n]


@pytest.mark.parametrize(
    ("grown_arcsec", "seed"), [(4.0, 0), (-9.0, 1), (6.0, 2), (-3.0, 3), (12.0, 4)]
)
def test_of_even_drift_no_change_of_the_rate_is_said(
    grown_arcsec: float, seed: int, tmp_path: Path
) -> None:
    assert drifted(tmp_path / "a.csv", np.linspace(0, 1, 6 * ROWS), grown_arcsec, seed) == []


@pytest.mark.parametrize(
    ("exponent", "how"), [(0.5, "the growth slows down"), (1.7, "the growth accelerates")]
)
def test_drift_at_another_rate_is_said_to_have_a_mean(
    exponent: float, how: str, tmp_path: Path
) -> None:
    share = np.linspace(0, 1, 6 * ROWS) ** exponent
    (said,) = drifted(tmp_path / "a.csv", share, 12.0, 0)
    assert how in said


def test_creep_s_share_is_of_the_last_decade_of_a_hold() -> None:
    """As docs/contract.md says it."""
    assert (
        "last decade of time adds in a hold of the record's median length, after a sudden load"
        in known_causes()["creep"].ratio
    )
