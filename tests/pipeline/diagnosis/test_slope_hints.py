"""What a slope far from the simulated one may come from: a unit's factor, a complete gear, a stated K."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from hidden.cases import draw_case
from mislabelled import NONE, Fault, mislabelled
from typer.testing import CliRunner

from flexspline.geometry.load import design_from, load_design
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.bend import Bend
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import Sweep, read_measurement
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome, NamedCause, Unexplained
from flexspline.pipeline.diagnosis.plausibility import refuse_absurd
from flexspline.pipeline.diagnosis.prediction import Prediction, prediction_of
from flexspline.pipeline.diagnosis.slope_hints import slope_hint, slope_off
from flexspline.pipeline.diagnosis.structure import BackwardLoop, LateAngle
from flexspline.results.cli import app
from flexspline.results.diagnosis.summary import summary

CASE = draw_case(1711, 1, "clean")
DESIGN = design_from(tomllib.loads(CASE.design))


def record(tmp_path: Path, fault: Fault = NONE) -> Path:
    path = tmp_path / "rig.csv"
    path.write_text(mislabelled(CASE, fault), encoding="utf-8")
    return path


def sweep(tmp_path: Path, fault: Fault = NONE) -> Sweep:
    read = read_measurement(record(tmp_path, fault))
    assert isinstance(read, Sweep)
    return read


def predicted(times_stiffer: float = 1.0) -> Prediction:
    return prediction_of(DESIGN, CASE.K_b * times_stiffer, CASE.K_e * times_stiffer)


def torque_in(factor_Nm: float) -> Fault:
    return Fault("torque_Nm", lambda v: v / factor_Nm, "torque_Nm")


@pytest.mark.parametrize(
    ("unit", "factor_Nm"),  # in N·m, NIST SP 811, appendix B.8
    [("in·lbf", 0.1129848), ("ft·lbf", 1.355818), ("kgf·m", 9.80665), ("kgf·cm", 0.0980665)],
)
def test_a_torque_in_another_unit_is_suspected(unit: str, factor_Nm: float, tmp_path: Path) -> None:
    hint = slope_hint(sweep(tmp_path, torque_in(factor_Nm)), predicted())
    assert hint is not None
    assert [(u.head, u.unit, u.other) for u in hint.units] == [("torque_Nm", "Nm", unit)]
    assert hint.slope.ratio == pytest.approx(factor_Nm, rel=0.05)


def test_a_right_slope_and_one_of_no_unit_s_factor_give_no_hint(tmp_path: Path) -> None:
    assert slope_hint(sweep(tmp_path), predicted()) is None
    assert slope_hint(sweep(tmp_path, torque_in(0.8)), predicted()) is None
    assert slope_hint(sweep(tmp_path, torque_in(1.2)), predicted()) is None


def test_a_record_twice_as_soft_may_be_of_a_complete_gear(tmp_path: Path) -> None:
    soft = sweep(tmp_path, torque_in(2.0))
    hint = slope_hint(soft, predicted())
    assert hint is not None
    assert hint.units == ()
    gear = predicted()
    curve = Prediction(gear.compliance, gear.compliance_std, gear.gap_arcsec, gear.gap_std_arcsec,
                       Bend((0.0, 1.0), (0.0, 0.1)))  # fmt: skip
    beside = slope_hint(soft, curve)
    assert beside is not None
    assert not beside.whole_gear  # it is compared with one already


def test_a_far_slope_that_no_cause_says_is_said(tmp_path: Path) -> None:
    """Two and a half times stiffer is no unit's factor, and no complete gear's."""
    stiff = sweep(tmp_path, torque_in(0.4))
    hint = slope_hint(stiff, predicted())
    assert hint is not None
    assert (hint.units, hint.whole_gear, hint.interchanged) == ((), False, False)
    assert slope_hint(stiff, predicted(), (series(-60.0, 0.3),)) is None  # its size says it
    off = slope_off(stiff, predicted())
    assert off is not None
    assert off.ratio == pytest.approx(0.4, rel=0.05)
    assert slope_off(sweep(tmp_path), predicted()) is None


def test_the_summary_says_them(tmp_path: Path) -> None:
    for factor, words in (
        (0.1129848, "to within about 5 % as with torque_Nm in in·lbf, not Nm"),
        (2.0, "--against gear"),
    ):
        path = record(tmp_path, torque_in(factor))
        said = summary(diagnose_file(DESIGN, path, CASE.K_b, CASE.K_e))
        assert words in said


def series(magnitude: float, std: float) -> NamedCause:
    return NamedCause("series_compliance", 1.0, (), magnitude, std, "%", 50.0, 1.0)


def test_a_named_compliance_is_the_slope(tmp_path: Path) -> None:
    read = sweep(tmp_path, torque_in(0.0980665))  # a straight line's slope is that of kgf·cm
    hint = slope_hint(read, predicted(), (series(-88.5, 0.46),))
    assert hint is not None
    assert [u.other for u in hint.units] == ["in·lbf"]
    assert hint.slope.ratio == pytest.approx(0.115)


def test_beside_soft_wind_up_a_straight_line_is_the_slope(tmp_path: Path) -> None:
    """Hardening leaves the share of a compliance wide, 148 ± 53 %, in every complete gear's record."""
    hardening = NamedCause("stiffness_hardening", 1.0, (), 1.3, 0.01, "-", 50.0, 1.0)
    soft, right = predicted(2.5), predicted()
    wide = series(148.0, 53.0)
    assert slope_hint(sweep(tmp_path), soft, (wide,)) is None
    hint = slope_hint(sweep(tmp_path), soft, (wide, hardening))
    assert hint is not None
    assert hint.slope.ratio == pytest.approx(2.5, rel=0.05)
    assert not hint.units
    assert slope_hint(sweep(tmp_path), right, (wide, hardening)) is None


def test_all_units_that_a_rough_slope_spans_are_named(tmp_path: Path) -> None:
    read = sweep(tmp_path, torque_in(0.105))
    hint = slope_hint(read, predicted(), (series(-89.5, 1.0),))
    assert hint is not None
    assert {u.other for u in hint.units} == {"in·lbf", "kgf·cm"}


def test_a_rough_slope_that_a_fault_may_bring_suggests_no_unit(tmp_path: Path) -> None:
    read = sweep(tmp_path, torque_in(1.36))
    assert slope_hint(read, predicted(), (series(36.0, 0.4),)) is not None  # ft·lbf
    assert slope_hint(read, predicted(), (series(36.0, 4.0),)) is None


def soft_wind_up(softer: float) -> str:
    """A gear of so many times the compliance, with a wind-up of 50 arcsec from side to side and a friction
    loop 10 arcsec wide at ± 16 N·m and less, as a file; readings scatter by 0.8 arcsec, fixed seed."""
    noise = np.random.default_rng(1)
    lines, friction, before, time = ["cycle,time_s,torque_Nm,angle_arcsec"], 0.0, 0.0, 0
    for cycle in range(1, 10):
        up = np.linspace(0, (5.3, 9.6, 16.0)[(cycle - 1) % 3], 30)
        for torque in np.concatenate([up, up[-2::-1], -up[1:], -up[-2::-1]]):
            friction = float(np.clip(friction + 6 * (torque - before), -5, 5))
            soft = np.sign(torque) * (30 + 25 * (1 - np.exp(-abs(torque) / 2)))
            angle = softer * PARTS.compliance * torque + soft - friction + noise.normal(0, 0.8)
            lines.append(f"{cycle},{time},{torque:.4f},{angle:.3f}")
            before, time = torque, time + 2
    return "\n".join(lines) + "\n"


XB1 = load_design(EXAMPLES / "xb1-40.toml")
PARTS = prediction_of(XB1, 31_300.0, 44_000.0)


@pytest.mark.parametrize(
    ("softer", "hinted"), [(1.0, False), (1.15, False), (1.3, False), (2.0, True), (2.5, True)]
)
def test_a_soft_wind_up_beside_a_compliance_hides_no_complete_gear(
    softer: float, hinted: bool, tmp_path: Path
) -> None:
    path = tmp_path / "rig.csv"
    path.write_text(soft_wind_up(softer), encoding="utf-8")
    found = diagnose_file(XB1, path, 31_300.0, 44_000.0)
    named = {c.id: c for c in found.outcome.causes}
    assert "stiffness_hardening" in named
    if hinted:  # each one's share of the slope is open, not their sum
        compliance = named["series_compliance"]
        assert compliance.magnitude < 3 * compliance.magnitude_std
    assert ("--against gear" in summary(found)) == hinted


@pytest.mark.parametrize(("softer", "unit"), [(1.5, ""), (9.80665, "kgf·m")])
def test_friction_and_temperature_leave_a_line_s_slope_rough(
    softer: float, unit: str, tmp_path: Path
) -> None:
    given = read_measurement(EXAMPLES / "measured" / "xb1-40-sweep.csv")
    assert isinstance(given, Sweep)
    h = given.history
    assert h.time_s is not None
    assert h.temperature_C is not None
    columns = (h.cycle, h.time_s, h.temperature_C, h.torque_Nm / softer, given.angle_arcsec)
    lines = [",".join(f"{v:.10g}" for v in row) for row in zip(*columns, strict=True)]
    path = tmp_path / "rig.csv"
    head = "cycle,time_s,temperature_C,torque_Nm,angle_arcsec"
    path.write_text("\n".join([head, *lines]), encoding="utf-8")
    read = read_measurement(path)
    assert isinstance(read, Sweep)
    gear = load_design(EXAMPLES / "xb1-40.toml")
    hint = slope_hint(read, prediction_of(gear, 31_300.0, 44_000.0))
    assert (hint is None) == (not unit)
    assert [u.other for u in (hint.units if hint else ())] == ([unit] if unit else [])


def test_a_stated_stiffness_is_doubted_beside_the_units(tmp_path: Path) -> None:
    wrong = CASE.K_b / 1000
    given = (f"--Kb {wrong:g}",)
    with pytest.raises(MeasurementError) as refusal:
        refuse_absurd(
            sweep(tmp_path), prediction_of(DESIGN, wrong, CASE.K_e), wrong, CASE.K_e, given
        )
    assert f"Or check the stiffness given: --Kb {wrong:g} (N·m/rad)." in str(refusal.value)
    ten = (CASE.K_b * 15, CASE.K_e * 15)  # not refused, and no cause
    found = diagnose_file(DESIGN, record(tmp_path), *ten, given=(f"--Kb {ten[0]:g}",))
    assert found.verdict == "unknown"
    assert f"Or check the stiffness given: --Kb {ten[0]:g} (N·m/rad)." in summary(found)


@pytest.mark.parametrize(
    "fault",
    [LateAngle("filter", 2.0, 0.1, 5.0), BackwardLoop(6.0, 5, None, None, None)],
)
def test_interchanged_columns_are_asked_for_beside_a_rig_s_fault(
    fault: LateAngle | BackwardLoop, tmp_path: Path
) -> None:
    """Of 0.6 arcsec per N·m: each reading taken for the other has a slope nearly three times as large."""
    K = 2 * ARCSEC_PER_RAD / 0.6
    gap = prediction_of(XB1, K, K).gap_arcsec
    torque = 150 * np.tile(np.interp(np.arange(100) / 100, [0, 0.25, 0.75, 1], [0, 1, -1, 0]), 4)
    angle = 0.6 * torque + gap / 2 * np.tanh(torque / 3)
    angle += np.random.default_rng(2).normal(0, 0.4, len(torque))
    found = {}
    for swapped in (True, False):
        columns = (angle, torque) if swapped else (torque, angle)
        lines = [
            f"{i // 100},{i},{t:.3f},{a:.3f}" for i, (t, a) in enumerate(zip(*columns, strict=True))
        ]
        path = tmp_path / f"{swapped}.csv"
        path.write_text(
            "\n".join(["cycle,time_s,torque_Nm,angle_arcsec", *lines]), encoding="utf-8"
        )
        diagnosis = diagnose_file(XB1, path, K, K)
        late = Unexplained("torque_rate", 5.0, 0.0, fault)
        outcome = DiagnosisOutcome("unknown", (), (late,))
        found[swapped] = summary(replace(diagnosis, outcome=outcome))
    assert found[True].endswith(
        "interchanged it would be close to the simulated one: check the columns."
    )
    assert "interchanged" not in found[False]
    assert "--against gear" not in found[False]


def test_interchanged_columns_are_asked_for_where_both_slopes_are_as_simulated(
    tmp_path: Path,
) -> None:
    """Of 1 arcsec per N·m: each reading taken for the other has the same slope, and a gap stepped back.

    The angle has a zero of its own, so the interchanged torque crosses its gap off zero.
    """
    K = 2 * ARCSEC_PER_RAD
    gap = prediction_of(XB1, K, K).gap_arcsec
    torque = 150 * np.tile(np.interp(np.arange(100) / 100, [0, 0.25, 0.75, 1], [0, 1, -1, 0]), 6)
    angle = 20 + torque + gap / 2 * np.sign(torque)
    angle += np.random.default_rng(2).normal(0, 0.4, len(torque))
    said = {}
    for swapped, columns in ((True, (angle, torque)), (False, (torque, angle))):
        rows = enumerate(zip(*columns, strict=True))
        text = "".join(f"{i // 100},{i},{t:.3f},{a:.3f}\n" for i, (t, a) in rows)
        path = tmp_path / f"{swapped}.csv"
        path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
        said[swapped] = summary(diagnose_file(XB1, path, K, K))
    assert said[True].endswith("as with torque and angle interchanged: check the columns.")
    assert "interchanged" not in said[False]


def test_a_turned_sign_is_no_stiffness_s_fault(tmp_path: Path) -> None:
    turned = sweep(tmp_path, Fault("angle_arcsec", lambda v: -v, "angle_arcsec"))
    with pytest.raises(MeasurementError, match=r"reversed\?$"):
        refuse_absurd(turned, predicted(), CASE.K_b, CASE.K_e, ("--Kb 3",))


def test_the_command_names_its_option(tmp_path: Path) -> None:
    words = ("diagnose", EXAMPLES / "xb1-40.toml", EXAMPLES / "measured" / "xb1-40-sweep.csv")
    options = ("--Kb", 31.3, "--Ke", 43339, "--out", tmp_path / "out")
    done = CliRunner().invoke(app, [str(w) for w in (*words, *options)])
    assert done.exit_code == 2
    assert "Or check the stiffness given: --Kb 31.3, --Ke 43339 (N·m/rad)." in done.stderr
