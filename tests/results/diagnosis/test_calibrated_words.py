"""What is said of a calibrated value that a record leaves open."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from histories import PREDICTION

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.calibration import Calibration, Estimate
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.prediction import prediction_of
from flexspline.results.diagnosis.console import diagnosis_table
from flexspline.results.diagnosis.data_used import calibrated_sentences


@pytest.mark.parametrize(
    ("gap_arcsec", "std_arcsec", "words"),
    [
        (62.0, 9.0, "62.0 ± 9.0 (as simulated: this record does not reduce the uncertainty)"),
        # two stated deviations of 10 off the simulated 60: not as simulated
        (40.0, 9.0, "40.0 ± 9.0 (simulated 60 ± 10; this record does not reduce the uncertainty)"),
        # surely another one, though not known any better
        (20.0, 9.0, "20.0 ± 9.0 (simulated 60 ± 10, −4.0 standard deviations)"),
        # known less well than simulated, but 4 stated deviations off
        (20.0, 19.0, "20 ± 19 (simulated 60 ± 10, −4.0 standard deviations)"),
        (40.0, 2.0, "40.0 ± 2.0 (simulated 60 ± 10, −2.0 standard deviations)"),
    ],
)
def test_a_value_off_the_simulated_one_is_not_as_simulated(
    gap_arcsec: float, std_arcsec: float, words: str
) -> None:
    calibration = Calibration(Estimate(gap_arcsec, std_arcsec), False)
    said = calibrated_sentences(calibration, PREDICTION, DiagnosisOutcome("unknown"))
    assert words in said


def test_an_error_says_how_far_the_calibration_went(tmp_path: Path) -> None:
    """A gap 3.5 stated deviations too small: the error within two of them is not that of the gap stated."""
    design = load_design(EXAMPLES / "xb1-40.toml")
    prediction = prediction_of(design, 31_300.0, 44_000.0)
    gap = prediction.gap_arcsec - 3.5 * prediction.gap_std_arcsec
    share = np.interp(np.arange(120) / 120, [0, 0.25, 0.75, 1], [0, 1, -1, 0])
    torque = 4.0 * np.tile(share, 5)
    angle = prediction.compliance * torque + gap / 2 * np.sign(torque)
    angle += np.random.default_rng(3).normal(0, 0.4, len(torque))
    rows = enumerate(zip(torque, angle, strict=True))
    path = tmp_path / "record.csv"
    text = "".join(f"{i // 120 + 1},{i},{t:.4f},{a:.3f}\n" for i, (t, a) in rows)
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    found = diagnose_file(design, path, 31_300.0, 44_000.0)
    assert found.verdict == "consistent"
    lines = {
        words: float(line.split()[-1])
        for line in diagnosis_table(found, tmp_path).splitlines()
        for words in ("within 2 stated deviations", "without this limit", "noise of the held-out")
        if words in line
    }
    within, free, noise = lines.values()
    # a step of 1.5 deviations of 13 arcsec is left, half of it on each side
    assert within > 10 * noise
    assert free == pytest.approx(noise, rel=0.1)
