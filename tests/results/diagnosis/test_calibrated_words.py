"""What is said of a calibrated value that a record leaves open."""

from __future__ import annotations

import pytest
from histories import PREDICTION

from flexspline.pipeline.diagnosis.calibration import Calibration, Estimate
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.results.diagnosis.data_used import calibrated_sentences


@pytest.mark.parametrize(
    ("gap_arcsec", "std_arcsec", "words"),
    [
        (62.0, 9.0, "62.0 ± 9.0 (as simulated: this record does not narrow it)"),
        # two stated deviations of 10 off the simulated 60: not as simulated
        (40.0, 9.0, "40.0 ± 9.0 (simulated 60 ± 10; this record does not narrow it)"),
        (40.0, 2.0, "40.0 ± 2.0 (simulated 60 ± 10, −2.0 standard deviations)"),
    ],
)
def test_a_value_off_the_simulated_one_is_not_as_simulated(
    gap_arcsec: float, std_arcsec: float, words: str
) -> None:
    calibration = Calibration(Estimate(gap_arcsec, std_arcsec), False)
    said = calibrated_sentences(calibration, PREDICTION, DiagnosisOutcome("unknown"))
    assert words in said
