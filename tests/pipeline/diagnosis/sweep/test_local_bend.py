"""A bend of the curve, on one side of zero or gradual on both, leaves compliance and gap as they are."""

from __future__ import annotations

import numpy as np
import pytest
from histories import PREDICTION
from read_sweep import as_read, history_of, simulated, steps

from flexspline.pipeline.diagnosis.calibration import Calibration
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.sweep.race.race import run_race
from flexspline.results.diagnosis.structure_words import structure_words

LARGEST_Nm, NOISE_ARCSEC = 8.0, 0.3
HISTORY = history_of(steps(LARGEST_Nm, 55), 5)
LOAD = np.abs(HISTORY.torque_Nm) / LARGEST_Nm


def diagnosed(added: np.ndarray, seed: int) -> tuple[DiagnosisOutcome, Calibration]:
    noise = np.random.default_rng(seed).normal(0, NOISE_ARCSEC, len(HISTORY))
    sweep = as_read(HISTORY, simulated(HISTORY) + added + noise)
    outcome, _ = diagnose_sweep(sweep, PREDICTION)
    return outcome, calibration_of(run_race(prepare(sweep, PREDICTION)))


def holds_the_truth(calibration: Calibration) -> bool:
    """Whether compliance and gap are the simulated ones, by three of the deviations stated."""
    found, gap = calibration.compliance, calibration.gap_arcsec
    assert found is not None
    slope_off = abs(found.value - PREDICTION.compliance) / found.std
    return slope_off < 3 and abs(gap.value - PREDICTION.gap_arcsec) / gap.std < 3


def only_form(outcome: DiagnosisOutcome) -> UnnamedForm:
    (only,) = outcome.unexplained
    assert isinstance(only.structure, tuple)
    (form,) = only.structure
    return form


@pytest.mark.parametrize(
    ("side", "twist", "begins"),
    [
        (
            1,
            8.0 * np.maximum(LOAD - 0.33, 0) / 0.67,
            0.33,
        ),  # a joint that opens one way, between 0.30 and 0.35
        (-1, 6.0 * LOAD**2, None),
        (-1, -6.0 * LOAD**2.5, None),  # stiffer at load
    ],
)
def test_a_bend_of_one_side_is_told_with_its_size(
    side: int, twist: np.ndarray, begins: float | None
) -> None:
    on_it = np.sign(HISTORY.torque_Nm) == side
    outcome, calibration = diagnosed(np.where(on_it, side * twist, 0.0), 3)
    assert outcome.verdict == "unknown"
    assert not outcome.causes
    form = only_form(outcome)
    assert form.kind == "one_sided"
    assert form.at_Nm is not None
    assert form.more_arcsec is not None
    assert form.at_Nm * side >= 0
    if begins is not None:  # a knee of 12 % in 1 100 rows of 0.3 arcsec
        assert side * form.at_Nm == pytest.approx(begins * LARGEST_Nm, abs=0.03 * LARGEST_Nm)
    # noise leaves ± 0.1 arcsec; a power found in place of another one some more
    assert form.more_arcsec == pytest.approx(twist[np.abs(twist).argmax()], abs=0.5)
    said = structure_words(outcome.unexplained[0])
    word = "positive" if side > 0 else "negative"
    assert f"a bend of the curve only at {word} torque" in said
    assert ("more twist" if twist.sum() > 0 else "less twist") in said
    assert holds_the_truth(calibration)


@pytest.mark.parametrize(
    "twist",
    [
        # slope that rises evenly between 0.3 and 0.7 of the torque
        np.where(LOAD < 0.3, 0, np.where(LOAD < 0.7, (np.maximum(LOAD, 0.3) - 0.3) ** 2 / 0.8, LOAD - 0.5)),
        # contact that shrinks as 1/T beyond 0.3
        np.where(LOAD > 0.3, LOAD - 0.3 - 0.3 * np.log(np.maximum(LOAD, 0.3) / 0.3), 0),
    ],
)  # fmt: skip
def test_a_joint_that_opens_gradually_is_no_ripple_and_no_spring(twist: np.ndarray) -> None:
    outcome, calibration = diagnosed(24.0 * twist * HISTORY.sign, 5)
    assert outcome.verdict == "unknown"
    assert not outcome.causes
    assert only_form(outcome).kind == "softening"
    assert holds_the_truth(calibration)


@pytest.mark.parametrize("height", [3.0, -6.0])
def test_an_even_curve_leaves_compliance_and_gap(height: float) -> None:
    outcome, calibration = diagnosed(height * LOAD**2, 6)
    assert only_form(outcome) == UnnamedForm("even_curve")
    assert holds_the_truth(calibration)


def test_a_straight_line_has_no_bend() -> None:
    outcome, calibration = diagnosed(np.zeros(len(HISTORY)), 7)
    assert outcome.verdict == "consistent"
    assert holds_the_truth(calibration)
