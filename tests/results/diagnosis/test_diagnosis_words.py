"""A diagnosis in words: one way to write a number, a sign and a cause, whatever was measured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.calibration import Calibration, Estimate
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Cause
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import EndPoints, Specimens, Sweep
from flexspline.pipeline.diagnosis.outcome import (
    DiagnosisOutcome,
    Doing,
    NamedCause,
    NextMeasurement,
    Unexplained,
)
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.stiffness_pair import StiffnessPair
from flexspline.results.diagnosis.advice import why
from flexspline.results.diagnosis.console import diagnosis_table
from flexspline.results.diagnosis.data_used import calibrated_sentences
from flexspline.results.diagnosis.notes import notes
from flexspline.results.diagnosis.record import diagnosis_record
from flexspline.results.diagnosis.summary import left_out, summary
from flexspline.results.records import as_json
from flexspline.results.report.compared import compared
from flexspline.results.report.diagnosis import diagnosis_document
from flexspline.results.studio.job_summary import job_summary

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
NONE = np.zeros(0)
HISTORY = History(NONE, NONE.astype(int), NONE.astype(int))
KINDS = {
    "sweep": Sweep(Path("m.csv"), HISTORY, NONE, (), (), NONE, True),
    "end_points": EndPoints(Path("m.csv"), (), NONE, NONE, NONE),
    "specimens": Specimens(Path("m.csv"), (), (), NONE, None, {}, NONE),
}


def named(cause: str, magnitude: float, unit: str = "%") -> NamedCause:
    return NamedCause(cause, 1.0, (), magnitude, 0.5, unit, 20.0, 3.0)


def test_rivals_of_units_judged_apart_are_said_by_unit() -> None:
    friction, rate = "friction_hysteresis", "rate_dependence"
    causes = (
        NamedCause(friction, 0.9, (rate,), 9.0, 0.1, "arcsec", 5.0, 4.0, own_units=("B",)),
        NamedCause(friction, 0.8, (rate,), 3.0, 0.1, "arcsec", 1.0, 1.4, own_units=("C",)),
        NamedCause(
            rate, 0.5, (friction,), 3.6, 0.4, "arcsec per N·m/s", 0.4, 1.4, own_units=("A",)
        ),
    )
    found = DiagnosisOutcome("ambiguous", causes)
    diagnosis = Diagnosis(DESIGN, KINDS["sweep"], Prediction(10.0, 0.2, 60.0, 5.0), found)
    text = summary(diagnosis)
    assert "which: unit B: friction hysteresis cannot be distinguished from rate dependence" in text
    assert "; unit C: friction hysteresis cannot be" in text
    assert (
        "; unit A: rate dependence (twist that lags torque) cannot be distinguished from fric"
        in text
    )
    lines = diagnosis_table(diagnosis, Path("out")).splitlines()
    assert [x.split("   ")[0].strip() for x in lines if "not decided" in x] == [
        "Friction hysteresis, unit B", "Friction hysteresis, unit C",
        "Rate dependence (twist that lags torque), unit A",
    ]  # fmt: skip


def test_a_stiffer_gear_is_no_part_left_out() -> None:
    soft, stiff = named("series_compliance", 12.0), named("series_compliance", -36.8)
    friction = named("friction_hysteresis", 12.0, "arcsec")
    said = "elastic part left out of the simulation, 12.00 ± 0.50 %"
    assert left_out([soft]) == f"The simulation leaves out: {said}."
    # 1/(1 − 0.368) = 1.5823, and 0.5 %/0.632² = 1.25 %
    stiffer = "gear stiffer than simulated, +58.2 ± 1.3 %"
    assert left_out([stiff]) == f"The simulation is too soft: {stiffer}."
    assert left_out([stiff, friction]) == (
        "The simulation leaves out: friction hysteresis, 12.00 ± 0.50 arcsec wide at T = 0. "
        f"The simulation is too soft: {stiffer}."
    )


def test_many_units_are_counted_and_not_all_listed() -> None:
    own = replace(
        named("series_compliance", 12.0), own_units=tuple(f"no{i}" for i in range(1, 193))
    )
    assert "(only no1, no2, no3, … no192 (192 units))" in left_out([own])


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_writes_a_magnitude_alike(kind: str) -> None:
    """A true minus sign, and digits to the second of the standard deviation."""
    outcome = DiagnosisOutcome("named", (named("thermal_clearance", -19.5, "arcsec/K"),))
    diagnosis = Diagnosis(DESIGN, KINDS[kind], Prediction(10.0, 0.2, 60.0, 5.0), outcome)
    assert diagnosis.kind == kind
    assert "−19.50 ± 0.50 arcsec/K" in summary(diagnosis)


@pytest.mark.parametrize("kind", KINDS)
def test_a_rival_is_named_in_the_advice(kind) -> None:
    rivals = ("series_compliance", "friction_hysteresis")
    after = NextMeasurement(
        "torque_Nm", "separate", rivals, Doing("hold"), "3", 5.0, None, (2.0, 1.0)
    )
    said = why(after, kind)
    assert "elastic part left out of the simulation" in said
    assert "friction hysteresis" in said


@pytest.mark.parametrize("cause", [c for c in known_causes().values() if c.unit in ("%", "1")])
def test_a_ratio_says_of_what(cause: Cause) -> None:
    assert cause.ratio
    found = DiagnosisOutcome("named", (named(cause.id, 2.0, cause.unit),))
    diagnosis = Diagnosis(DESIGN, KINDS["sweep"], Prediction(1.0, 1.0, 0.0, 0.0), found)
    (note,) = (n for n in notes(diagnosis) if n.startswith("size of"))
    assert note == f"size of {cause.title_at(2.0)}: {cause.ratio}"
    if cause.unit == "1":  # a number alone says nothing
        assert cause.factor
        assert f"2.00 ± 0.50 {cause.factor}." in summary(diagnosis)


def test_sizes_stand_below_each_other_however_long_a_title_is() -> None:
    causes = (named("kinematic_error", 9.0, "arcsec"), named("friction_hysteresis", 12.0, "arcsec"))
    found = DiagnosisOutcome("named", (*causes, named("stiffness_hardening", 2.3, "1")))
    diagnosis = Diagnosis(DESIGN, KINDS["sweep"], Prediction(10.0, 0.2, 60.0, 5.0), found)
    rows = [r for r in diagnosis_table(diagnosis, Path("out")).splitlines() if "beyond doubt" in r]
    assert len(rows) == 3
    assert len({row.index(" ± ") for row in rows}) == 2  # 9.00 and 1.30, 12.00
    assert len({row.index("beyond doubt") for row in rows}) == 1


def test_a_simulated_gap_is_written_alike_on_a_page() -> None:
    prediction = Prediction(6.0132, 0.12, 57.55, 10.02)
    calibration = Calibration(Estimate(37.9, 2.0), False, Estimate(6.2, 0.05))
    outcome = DiagnosisOutcome("consistent")
    diagnosis = Diagnosis(DESIGN, KINDS["sweep"], prediction, outcome)
    said = compared(diagnosis, StiffnessPair(66_783.0, 71_150.0))
    calibrated = calibrated_sentences(calibration, prediction, outcome)
    for words in ("58 ± 10", "6.01 ± 0.12"):
        assert words in said
        assert words in calibrated


def test_what_specimens_leave_is_in_percent_everywhere() -> None:
    trend = Unexplained("specimen_order", 6.5, 1e-5, (UnnamedForm("trend"),), unit="%")
    outcome = DiagnosisOutcome("unknown", unexplained=(trend,))
    found = Diagnosis(DESIGN, KINDS["specimens"], Prediction(10.0, 0.2, 60.0, 5.0), outcome)
    record = diagnosis_record(found)
    assert record["unexplained"][0]["unit"] == "%"
    table = diagnosis_table(found, Path("out"))
    assert "unexplained in the order of the specimens: 6.50 % rms" in " ".join(table.split())
    report = repr(diagnosis_document(found, (), StiffnessPair(1.0, 1.0)).blocks)
    assert "Size, % rms" in report
    page = job_summary("diagnose", DESIGN, as_json(record))
    (line,) = page["diagnosis"]["unexplained"]
    assert line.endswith("6.5 % rms")
    assert not any("arcsec rms" in said for said in (table, report, line))


def test_structure_without_a_name_lies_in_a_channel_that_is_said_in_words() -> None:
    forms = (UnnamedForm("trend"),)
    left = tuple(Unexplained(key, 6.5, 1e-5, forms) for key in ("torque_Nm", "cycle", "torque_Nm"))
    found = Diagnosis(
        DESIGN,
        KINDS["sweep"],
        Prediction(10.0, 0.2, 60.0, 5.0),
        DiagnosisOutcome("unknown", unexplained=left),
    )
    said = "There is structure in torque, load cycle that no known cause explains."
    assert summary(found) == said


def test_the_live_page_says_a_cause_as_the_table_does() -> None:
    friction = replace(named("friction_hysteresis", 12.0, "arcsec"), widest_arcsec=30.0)
    zone = replace(named("load_zone", 1.4, "1"), none=1.0)  # 0.8 of its deviations from none
    outcome = DiagnosisOutcome("named", (friction, zone))
    found = Diagnosis(DESIGN, KINDS["specimens"], Prediction(10.0, 0.2, 60.0, 5.0), outcome)
    page = job_summary("diagnose", DESIGN, as_json(diagnosis_record(found)))["diagnosis"]
    loop, load = page["causes"]
    assert loop["title"] == "Friction hysteresis (loop up to 30.0 arcsec wide)"
    assert loop["magnitude"] == "12.00 ± 0.50 arcsec wide at T = 0"
    assert load["sure"] == "an effect exists, its size is not known"


def test_two_that_stand_for_each_other_are_said_once() -> None:
    friction = NamedCause(
        "friction_hysteresis", 0.5, ("rate_dependence",), 1.7, 1.6, "arcsec", 9.0, 1.0
    )
    lag = NamedCause("rate_dependence", 0.5, ("friction_hysteresis",), 0.1, 0.06, "1", 9.0, 1.0)
    wear = NamedCause(
        "wear", 0.6, ("sensor_drift", "rate_dependence"), 1.0, 0.1, "arcsec/cycle", 9.0, 0.5
    )
    outcome = DiagnosisOutcome("ambiguous", (friction, lag, wear))
    prediction = Prediction(10.0, 0.3, 70.0, 10.0)
    said = summary(Diagnosis(DESIGN, KINDS["sweep"], prediction, outcome))
    assert said.count("cannot be distinguished from") == 2
    assert "distinguished from drift of the angle reading or rate dependence" in said
    assert "suspected" not in said


def test_beside_an_unknown_effect_what_is_not_decided_is_not_identified() -> None:
    lag = NamedCause(
        "rate_dependence", 0.5, ("friction_hysteresis",), 1.2, 0.1, "arcsec per N·m/s", 9.0, 1.0
    )
    left = Unexplained("temperature_C", 3.0, 1e-6, (UnnamedForm("changing_loop"),))
    outcome = DiagnosisOutcome("unknown", (lag,), (left,))
    prediction = Prediction(10.0, 0.3, 70.0, 10.0)
    said = summary(Diagnosis(DESIGN, KINDS["sweep"], prediction, outcome))
    assert "identified" not in said
    assert "cannot be distinguished from friction hysteresis" in said
