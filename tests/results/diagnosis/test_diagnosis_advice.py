"""What to do next where structure has no name, and what its verdict says of the calibrated figures."""

import pytest

from flexspline.pipeline.diagnosis.calibration import Calibration, Estimate
from flexspline.pipeline.diagnosis.outcome import (
    DiagnosisOutcome,
    NamedCause,
    NextMeasurement,
    Unexplained,
)
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.slope_hints import SlopeRatio
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.results.diagnosis.advice import SHOWS_STRUCTURE, why
from flexspline.results.diagnosis.channels import CHANNELS, channel_words
from flexspline.results.diagnosis.data_used import calibrated_sentences


@pytest.mark.parametrize("channel", sorted({*CHANNELS, *SHOWS_STRUCTURE}))
def test_structure_is_sought_in_words_not_in_keys(channel: str) -> None:
    said = why(
        NextMeasurement(channel, "find_structure", structure=(UnnamedForm("jumps"),)), "sweep"
    )
    assert said.startswith(
        f"the structure lies in {channel_words(channel)} (jumps while the torque changes; "
    )
    assert "_" not in said


@pytest.mark.parametrize("channel", ["angle_arcsec", "direction"])
def test_nothing_is_asked_for_that_a_rig_cannot_do(channel: str) -> None:
    """With the wave generator locked the output angle is the answer: it cannot be varied alone."""
    form = (UnnamedForm("ripple" if channel == "angle_arcsec" else "leading"),)
    said = why(NextMeasurement(channel, "find_structure", structure=form), "sweep")
    assert "vary only this channel" not in said
    assert "housing" in said or "hold it" in said


def test_an_unexplained_effect_makes_the_calibrated_figures_doubtful() -> None:
    prediction = Prediction(10.0, 0.0, 70.0, 0.0)
    calibration = Calibration(Estimate(70.0, 0.1), False, Estimate(10.0, 0.01))
    left = Unexplained("time_s", 1.0, 1e-6, (UnnamedForm("wave"),))
    unknown = calibrated_sentences(
        calibration, prediction, DiagnosisOutcome("unknown", unexplained=(left,))
    )
    assert calibrated_sentences(calibration, prediction, DiagnosisOutcome("consistent")) in unknown
    assert "An unexplained effect may have changed these values" in unknown


def test_an_elastic_cause_makes_the_calibrated_compliance_a_part_of_the_slope() -> None:
    prediction = Prediction(10.0, 0.3, 70.0, 10.0)
    calibration = Calibration(Estimate(70.0, 0.1), True, Estimate(10.0, 0.01))
    titles = {"series_compliance": "elastic part left out", "friction_hysteresis": "friction"}
    said = {
        cause: calibrated_sentences(
            calibration,
            prediction,
            DiagnosisOutcome("named", (NamedCause(cause, 1.0, (), 12.0, 0.5, "%", 20.0, 3.0),)),
        )
        for cause in titles
    }
    assert "the effect of: elastic part left out" in said["series_compliance"]
    assert "slope" not in said["friction_hysteresis"]


def test_what_a_record_does_not_narrow_is_not_called_measured() -> None:
    prediction = Prediction(10.0, 0.3, 70.0, 10.0)
    calibration = Calibration(Estimate(70.0, 0.1), True, Estimate(10.0, 0.29))
    said = calibrated_sentences(calibration, prediction, DiagnosisOutcome("consistent"))
    assert "gap 70.00 ± 0.10 (simulated 70 ± 10" in said
    assert "as simulated: this record does not reduce the uncertainty" in said


def test_a_slope_that_a_compliance_does_not_have_is_said_beside_it() -> None:
    """Held as simulated while the record is 6.5 times stiffer, it is not what the record leaves open."""
    prediction = Prediction(10.0, 0.3, 70.0, 10.0)
    held = Calibration(Estimate(70.0, 0.1), True, Estimate(10.0, 0.29))
    found = DiagnosisOutcome("unknown")
    said = calibrated_sentences(held, prediction, found, SlopeRatio(0.154, 0.153, 0.155))
    assert "does not reduce" not in said
    assert "6.49 times stiffer: a straight line through the record has a slope of 1.54" in said
    # a compliance that follows the slope says it by itself
    moved = Calibration(Estimate(70.0, 0.1), True, Estimate(8.6, 0.05))
    said = calibrated_sentences(moved, prediction, found, SlopeRatio(0.86, 0.85, 0.87))
    assert "own slope" not in said
    assert "standard deviations" in said


@pytest.mark.parametrize(
    ("percent", "title"), [(-9.0, "gear stiffer"), (9.0, "elastic part left out")]
)
def test_the_next_measurement_names_a_cause_as_the_verdict_does(percent: float, title: str) -> None:
    found = NamedCause("series_compliance", 1.0, (), percent, 0.5, "%", 20.0, 3.0)
    confirm = NextMeasurement("torque_amplitude", "confirm", ("series_compliance",))
    assert f"to confirm {title}" in why(confirm, "sweep", (found,))


@pytest.mark.parametrize(
    ("separation", "said"),
    [
        (3.0, "; this distinguishes"),
        (0.4, "about 50 such specimens are needed to distinguish"),  # 8 / 0.4²
        (0.1, "too little to distinguish"),
    ],
)
def test_a_specimen_distinguishes_only_beyond_the_noise(separation: float, said: str) -> None:
    """Rivals lie 4 nats apart (docs/contract.md): half a square of n specimens' separation."""
    after = NextMeasurement(
        "flexspline.length_mm",
        "separate",
        ("youngs_modulus", "series_compliance"),
        separation=separation,
        dimension_mm=(30.0, 20.0),
    )
    assert said in why(after, "specimens")


def test_nothing_found_is_not_calibrated_beside_effects() -> None:
    calibration = Calibration(Estimate(70.0, 0.1), True, Estimate(10.0, 0.01))
    prediction = Prediction(10.0, 0.3, 70.0, 10.0)
    said = calibrated_sentences(calibration, prediction, DiagnosisOutcome("consistent"))
    assert "without the other effects" not in said


def test_a_gap_beside_the_clearance_found_is_not_called_open() -> None:
    """The record has it narrowly: the simulated gap and the clearance found together."""
    found = NamedCause("clearance_offset", 1.0, (), 35.0, 0.06, "arcsec", 20.0, 17.0)
    calibration = Calibration(Estimate(71.0, 9.9), True, Estimate(10.0, 0.01))
    prediction = Prediction(10.0, 0.3, 70.0, 10.0)
    said = calibrated_sentences(calibration, prediction, DiagnosisOutcome("named", (found,)))
    assert "does not reduce" not in said
    assert "the difference counts as clearance other than simulated" in said
