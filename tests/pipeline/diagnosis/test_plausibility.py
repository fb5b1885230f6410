"""Sizes that no gear has: refused with the reason, or unknown; records of real sizes are not touched."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from hidden.case import Case
from hidden.cases import draw_case
from mislabelled import ABSURD, NONE, STRANGE, Fault, mislabelled

from flexspline.geometry.load import design_from, load_design
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import (
    EndPoints,
    Measurement,
    Specimens,
    Sweep,
    read_measurement,
)
from flexspline.pipeline.diagnosis.plausibility import refuse_absurd
from flexspline.pipeline.diagnosis.prediction import Prediction, prediction_of
from flexspline.pipeline.diagnosis.shortage import Drowned
from flexspline.pipeline.diagnosis.sweep.twist_ratio import sweep_size
from flexspline.results.diagnosis.record import diagnosis_record
from flexspline.results.diagnosis.summary import summary

SEED = 1711
CLEAN = [draw_case(SEED, k, "clean") for k in range(4)]
ROOT = Path(__file__).parents[3]


def predicted(case: Case) -> Prediction:
    return prediction_of(design_from(tomllib.loads(case.design)), case.K_b, case.K_e)


def checked(case: Case, text: str, tmp_path: Path) -> Measurement:
    """The measurement, which is not refused."""
    path = tmp_path / "rig.csv"
    path.write_text(text, encoding="utf-8")
    measurement = read_measurement(path)
    refuse_absurd(measurement, predicted(case), case.K_b, case.K_e)
    return measurement


def diagnosed(case: Case, text: str, tmp_path: Path) -> Diagnosis:
    path = tmp_path / "rig.csv"
    path.write_text(text, encoding="utf-8")
    return diagnose_file(design_from(tomllib.loads(case.design)), path, case.K_b, case.K_e)


@pytest.mark.parametrize("name", ABSURD)
@pytest.mark.parametrize("number", range(len(CLEAN)))
def test_an_absurd_size_is_refused_with_its_reason(name: str, number: int, tmp_path: Path) -> None:
    fault, asked = ABSURD[name]
    with pytest.raises(MeasurementError) as refusal:
        checked(CLEAN[number], mislabelled(CLEAN[number], fault), tmp_path)
    assert asked in str(refusal.value)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("number", range(16))
def test_records_with_effects_of_real_size_are_not_refused(number: int, tmp_path: Path) -> None:
    """Any of the hidden effects, alone and in pairs, and effects of no known cause."""
    case = draw_case(SEED + 1, number)
    sweep = checked(case, mislabelled(case, NONE), tmp_path)
    assert isinstance(sweep, Sweep)
    size = sweep_size(sweep.history, sweep.angle_arcsec, predicted(case))
    assert size is not None
    # no effect of real size doubles or halves the twist; 30 times is absurd
    assert 1 / 2 < size.chord < 2


@pytest.mark.usefixtures("causes_only")
def test_interchanged_columns_are_asked_for(tmp_path: Path) -> None:
    """Torque read as the angle and the angle as torque: a gear of the simulated size, the other way."""
    case = CLEAN[0]
    interchanged = case.csv.replace("torque_Nm", "?").replace("angle_arcsec", "torque_Nm")
    with pytest.raises(MeasurementError, match="columns of torque and angle interchanged"):
        checked(case, interchanged.replace("?", "angle_arcsec"), tmp_path)
    with pytest.raises(MeasurementError) as caught:
        checked(case, mislabelled(case, Fault("angle_arcsec", float, "angle_deg")), tmp_path)
    assert "columns of torque" not in str(caught.value)


LARGE = load_design(EXAMPLES / "xb1-40.toml")
LARGE_K = 2 * ARCSEC_PER_RAD / 2.5
"""Of flexspline and of shaft: 2.5 arcsec per N·m together. At 1 arcsec per N·m no slope would tell."""


def large_record(
    tmp_path: Path, swapped: bool, both_sides: bool = True, softer: float = 1.0
) -> Path:
    """Two cycles of 2.5·T, `softer` times, and 30·sign T arcsec, friction of 2 N·m ahead of it, and noise."""
    noise = np.random.default_rng(12)
    wave = np.sin(np.linspace(0, 4 * np.pi, 400)) * 120.0
    torque = wave if both_sides else np.abs(wave) + 5.0
    at, lines = 0.0, ["time_s,torque_Nm,angle_arcsec"]
    for i, now in enumerate(torque):
        at = min(max(at, now - 2.0), now + 2.0)
        angle = softer * 2.5 * at + 30.0 * np.sign(at) + noise.normal(0, 0.3)
        pair = (angle, now) if swapped else (now, angle)
        lines.append(f"{2 * i},{pair[0]:.4f},{pair[1]:.4f}")
    path = tmp_path / "large.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_interchanged_columns_of_a_stiff_gear_are_refused(tmp_path: Path) -> None:
    """Slope 1/2.5 for 2.5, and the gap steps back: a size that gears have, but both numbers say the same."""
    prediction = prediction_of(LARGE, LARGE_K, LARGE_K)
    assert prediction.compliance == pytest.approx(2.5)
    with pytest.raises(MeasurementError, match="columns of torque and angle interchanged"):
        refuse_absurd(read_measurement(large_record(tmp_path, True)), prediction, LARGE_K, LARGE_K)
    for softer in (0.5, 1.0, 3.5, 6.0):  # as much off the other way: the gap steps on
        right = read_measurement(large_record(tmp_path, False, softer=softer))
        refuse_absurd(right, prediction, LARGE_K, LARGE_K)


def test_where_no_gap_shows_interchanged_columns_are_asked_for(tmp_path: Path) -> None:
    found = diagnose_file(LARGE, large_record(tmp_path, True, both_sides=False), LARGE_K, LARGE_K)
    assert "with torque and angle interchanged it would be close" in summary(found)
    found = diagnose_file(LARGE, large_record(tmp_path, False, both_sides=False), LARGE_K, LARGE_K)
    assert "interchanged" not in summary(found)


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.long] * (n != "degrees as mrad")) for n in STRANGE]
)
def test_more_than_ten_times_is_no_cause(name: str, tmp_path: Path) -> None:
    fault, asked = STRANGE[name]
    record = diagnosis_record(diagnosed(CLEAN[0], mislabelled(CLEAN[0], fault), tmp_path))
    assert record["verdict"] == "unknown"
    assert record["causes"] == []
    assert asked in record["summary"]
    assert asked in record["unexplained"][0]["what"]


def test_a_reading_that_drowns_in_noise_says_nothing(tmp_path: Path) -> None:
    case, rng = CLEAN[1], np.random.default_rng(3)
    twist = np.ptp([a for unit in case.units for a in unit.angle])
    noisy = Fault("angle_arcsec", lambda v: float(v + 4 * twist * rng.normal()), "angle_arcsec")
    found = diagnosed(case, mislabelled(case, noisy), tmp_path)
    assert found.verdict == "insufficient"
    assert isinstance(found.outcome.too_little, Drowned)


def test_no_cause_needs_a_negative_gap(tmp_path: Path) -> None:
    """Twist at each side less than a line through zero gives: play that pushes."""
    case = CLEAN[2]
    unit = case.units[0]
    gap = 0.5 * case.rig.compliance * unit.program.peak + case.rig.gap
    rows = np.sign(unit.true_torque)
    head = "time_s,torque_Nm,angle_arcsec"
    time = unit.program.time[unit.program.rows]
    values = zip(time, unit.torque, unit.angle - gap * rows, strict=True)
    text = "\n".join([head, *(",".join(map(repr, map(float, v))) for v in values)]) + "\n"
    found = diagnosed(case, text, tmp_path)
    assert not found.causes
    assert found.verdict == "unknown"


END_POINTS = "unit,torque_Nm,{plus},{minus}\n"


@pytest.mark.parametrize(
    ("unit", "factor", "needle"),
    [("arcsec", -1, "reversed?"), ("arcmin", 1, "in arcsec, not arcmin"), ("deg", 1, "in arcsec, not deg"),
     ("arcsec", 1 / 206.265, "in mrad, not arcsec"), ("arcsec", 1, "")],
)  # fmt: skip
def test_end_points(unit: str, factor: float, needle: str, tmp_path: Path) -> None:
    case = CLEAN[0]
    half = (0.5 * case.rig.compliance + case.rig.gap / 2) * factor
    head = END_POINTS.format(plus=f"angle_plus_{unit}", minus=f"angle_minus_{unit}")
    text = head + "".join(f"u{i},0.5,{half * (1 + i / 50)},{-half}\n" for i in range(5))
    if not needle:
        points = checked(case, text, tmp_path)
        assert isinstance(points, EndPoints)
        assert points.unit == ("u0", "u1", "u2", "u3", "u4")
        return
    with pytest.raises(MeasurementError, match=needle):
        checked(case, text, tmp_path)


@pytest.mark.parametrize(
    ("unit", "part", "factor", "needle"),
    [("Nm_per_rad", "flexspline", 1e-3, "in kNm/rad, not Nm/rad"), 
     ("Nm_per_arcmin", "shaft", 1, "in Nm/rad"),
     ("Nm_per_rad", "series", 1, ""), ("Nm_per_rad", "flexspline", 20, "")],
)  # fmt: skip
def test_specimens(unit: str, part: str, factor: float, needle: str, tmp_path: Path) -> None:
    case = CLEAN[0]
    K = {"flexspline": case.K_b, "shaft": case.K_e, "series": 1 / (1 / case.K_b + 1 / case.K_e)}
    rows = "".join(f"s{i},{K[part] * factor * (1 + i / 100)},{part}\n" for i in range(4))
    text = f"specimen,stiffness_{unit},part\n{rows}"
    if not needle:
        specimens = checked(case, text, tmp_path)
        assert isinstance(specimens, Specimens)
        assert specimens.part == (part,) * 4
        return
    with pytest.raises(MeasurementError, match=needle):
        checked(case, text, tmp_path)


def test_an_angle_that_never_changes_was_not_connected(tmp_path: Path) -> None:
    rows = "\n".join(f"{t:.2f},153.2" for t in np.linspace(-2, 2, 60))
    with pytest.raises(MeasurementError) as refusal:
        checked(CLEAN[0], f"torque_Nm,angle_arcsec\n{rows}\n", tmp_path)
    assert str(refusal.value).endswith(
        "the angle is the same in all rows: was its channel connected?"
    )
