"""What calibrating stiffness and gap alone can do, and how a gear stiffer than simulated is worded."""

from __future__ import annotations

from pathlib import Path
from re import findall

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from histories import LARGEST, PREDICTION
from histories import sweep as swept

from flexspline.geometry.load import load_design
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.calibration import Calibration, Estimate
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.prediction import prediction_of
from flexspline.pipeline.diagnosis.sweep.calibrated_residual import (
    ALLOWED_SIGMAS,
    calibrated_residual,
    less_zero,
)
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    gaussian_evidence,
)
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import design_matrix
from flexspline.results.diagnosis.console import diagnosis_table
from flexspline.results.diagnosis.notes import notes
from flexspline.results.diagnosis.summary import summary

SIGMA = 0.5
DESIGN = load_design(EXAMPLES / "xb1-40.toml")


def raced(compliance: float, gap: float) -> GaussianEvidence:
    """A record that lacks nothing but so many standard deviations of stiffness and gap."""
    history = swept(cycles=2)
    columns = design_matrix(
        FitContext(PREDICTION, history), {"clearance_offset": known_causes()["clearance_offset"]}
    )
    target = columns.base[:, 1:3] @ (np.array([compliance, gap]) * columns.base_prior[1:3])
    kept = np.abs(history.torque_Nm) > 0.07 * LARGEST
    return gaussian_evidence(columns, target, kept, Noise(SIGMA**2, 0.0, 0.5))


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def test_within_its_doubt_the_calibration_takes_all_away() -> None:
    now = raced(1.0, -1.0)
    before = rms(less_zero(now.target, now.kept, now.columns.rig.history)[now.kept])
    # the prior pulls the calibration back by what the noise lets it: far below a tenth
    assert rms(calibrated_residual(now)[now.kept]) < 0.1 * before


@pytest.mark.parametrize(("compliance", "gap"), [(8.0, -8.0), (-8.0, 8.0), (8.0, 1.0), (-1.0, 8.0)])
def test_no_other_calibration_within_its_limits_is_better(compliance: float, gap: float) -> None:
    """Against a fine grid of both; stiffness and gap look alike, so limits one by one are not the best."""
    now = raced(compliance, gap)
    history, base, prior = now.columns.rig.history, now.columns.base, now.columns.base_prior
    ends = np.linspace(-ALLOWED_SIGMAS, ALLOWED_SIGMAS, 41)
    tried = [
        rms(
            less_zero(
                now.target - base[:, 1:3] @ (np.array([c, g]) * prior[1:3]), now.kept, history
            )[now.kept]
        )
        for c in ends
        for g in ends
    ]
    # the prior counts against each calibration too, as 4 of some thousand squares at the limit
    assert rms(calibrated_residual(now)[now.kept]) <= min(tried) * 1.01


def test_a_quantity_far_from_the_simulation_is_said_with_its_distance() -> None:
    """The simulation has a gap of 60 ± 10 arcsec and 10 ± 0.3 arcsec per N·m."""
    near = Calibration(Estimate(89.0, 0.1), False, Estimate(9.2, 0.1))
    assert near.far_off(PREDICTION) == ()
    (gap,) = Calibration(Estimate(25.0, 0.1), False, Estimate(10.5, 0.1)).far_off(PREDICTION)
    assert (gap.quantity, gap.deviations) == ("gap", pytest.approx(3.5))
    (soft,) = Calibration(Estimate(60.0, 0.1), False, Estimate(11.2, 0.1)).far_off(PREDICTION)
    assert (soft.quantity, soft.deviations) == ("compliance", pytest.approx(4.0))


def test_a_value_that_the_record_leaves_open_lies_nowhere() -> None:
    """5 of the stated deviations from 60 ± 10, but only 2.8 of its own."""
    assert Calibration(Estimate(10.0, 18.0), False).far_off(PREDICTION) == ()
    assert Calibration(Estimate(10.0, 16.0), False).far_off(PREDICTION) != ()


def test_a_consistent_record_with_a_gap_far_off_says_so(tmp_path: Path) -> None:
    """A right form, but a gap 3.5 of the stated deviations too wide: evidence that does not name it."""
    phase = (np.arange(180) + 0.5) / 60
    torque = 4 / np.pi * np.arcsin(np.sin(2 * np.pi * phase))
    compliance = (1 / 31300 + 1 / 43000) * ARCSEC_PER_RAD
    prediction = prediction_of(DESIGN, 31300.0, 43000.0)
    gap = prediction.gap_arcsec + 3.5 * prediction.gap_std_arcsec
    noise = np.random.default_rng(1).normal(0, 1.0, 180)
    angle = compliance * torque + gap / 2 * np.sign(torque) + noise
    csv = tmp_path / "wide.csv"
    rows = zip(60 * phase, phase.astype(int), torque, angle, strict=True)
    csv.write_text(
        "time_s,cycle,torque_Nm,angle_arcsec\n"
        + "".join(f"{t:.3f},{c},{q:.4f},{a:.3f}\n" for t, c, q, a in rows)
    )
    found = diagnose_file(DESIGN, csv, 31300.0, 43000.0)
    assert found.verdict == "consistent"
    assert "but the gap" in summary(found)
    assert "3.5 stated standard deviations" in summary(found)
    table = " ".join(diagnosis_table(found, tmp_path).split())
    assert "agree" not in table
    assert "No effect" not in table
    assert "(simulated 72 ± 13, +3.5 standard deviations)" in table


def test_one_unit_with_a_gap_far_off_is_said_beside_others_that_agree(tmp_path: Path) -> None:
    """Of four units one has a gap 5 of the stated deviations too wide, and too few rows for a verdict."""
    phase = (np.arange(180) + 0.5) / 60
    torque = 4 / np.pi * np.arcsin(np.sin(2 * np.pi * phase))
    compliance = (1 / 31300 + 1 / 43000) * ARCSEC_PER_RAD
    prediction = prediction_of(DESIGN, 31300.0, 43000.0)
    rng, lines = np.random.default_rng(1), []
    for unit, off in zip("ABCD", (0.5, -0.3, -0.4, 5.0), strict=True):
        gap = prediction.gap_arcsec + off * prediction.gap_std_arcsec
        own = compliance * (1.03 if unit == "D" else 1.0)
        angle = own * torque + gap / 2 * np.sign(torque) + rng.normal(0, 0.2, 180)
        rows = zip(60 * phase, phase.astype(int), torque, angle, strict=True)
        written = [f"{unit},{t:.3f},{c},{q:.4f},{a:.3f}\n" for t, c, q, a in rows]
        lines += written[:: 8 if unit == "D" else 1]
    csv = tmp_path / "units.csv"
    csv.write_text("unit,time_s,cycle,torque_Nm,angle_arcsec\n" + "".join(lines))
    found = diagnose_file(DESIGN, csv, 31300.0, 43000.0)
    said = summary(found)
    assert "gap of unit D" in said
    assert " 5.0 stated standard deviations" in said
    assert "unit A" not in said
    (softer,) = [n for n in notes(found) if n.startswith("difference of each unit's compliance")]
    each = {
        u: float(v.replace("\N{MINUS SIGN}", "-")) for u, v in findall(r"([A-D]) (\S+) %", softer)
    }
    # 0.2 arcsec in 23 rows, 0.58 N·m rms about either side's mean: 0.64 % of the slope
    assert each["D"] - each["A"] == pytest.approx(3.0, abs=3 * 0.68)
