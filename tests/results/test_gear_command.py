"""`flexspline gear`: keys, files, what is assumed, and one line for what cannot be built."""

from __future__ import annotations

import csv
import json
import tomllib
from pathlib import Path

import in_process
import numpy as np
import pytest
from example_files import EXAMPLES

import flexspline
from flexspline.geometry.design import Design
from flexspline.geometry.gear_assumptions import gear_assumptions
from flexspline.geometry.load import design_from
from flexspline.geometry.sized import sized_template
from flexspline.geometry.template import design_text
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.gear.gear_chain import chain_of
from flexspline.pipeline.gear.gear_curve import LAWS, LOADING, GearCurve, curve_of
from flexspline.pipeline.gear.gear_model import pair_compliance
from flexspline.pipeline.stiffnesses import Stiffnesses
from flexspline.results.console import table
from flexspline.results.gear import gear_record, write_gear
from flexspline.results.gear_words import gear_notes, gear_warnings
from flexspline.results.numbers import THIN
from flexspline.results.quantities import quantity

UP = len(LOADING)
"""Rows of the first way up."""
STEEL = {"name": "a steel", "youngs_modulus_GPa": 206.0, "poissons_ratio": 0.3}
DESIGN = flexspline.load_design(EXAMPLES / "xb1-40.toml").changed(
    # a shaft without holes is solved on its meridian: this is no test of tetrahedra
    {"shaft.bolt_count": 0, "gear.rated_torque_Nm": 20.0}
)


@pytest.fixture(scope="module")
def curve() -> GearCurve:
    return flexspline.gear(DESIGN)


def alone(design: Design) -> GearCurve:
    """The curve without the terms at the load and without the ratcheting torque: half the work."""
    return curve_of(design, chain_of(analysis_context(design)))


def test_the_contract_s_keys(curve: GearCurve) -> None:
    record = json.loads(json.dumps(gear_record(DESIGN, curve, Stiffnesses({}), 1.0)))
    assert {
        "K1_Nm_per_rad", "K2_Nm_per_rad", "K3_Nm_per_rad", "T1_Nm", "T2_Nm", "lost_motion_arcsec",
        "teeth_in_contact", "compliance_shares",
    } <= set(record)  # fmt: skip
    assert "hysteresis_loss_arcsec" not in record
    assert set(record["compliance_shares"]) == {"flexspline", "shaft", "teeth", "bearing"}
    assert sum(record["compliance_shares"].values()) == pytest.approx(1)
    assert (record["T1_Nm"], record["T2_Nm"]) == pytest.approx((3.0, 10.0))


def test_it_stiffens_and_turns_both_ways_alike(curve: GearCurve) -> None:
    assert curve.K1_Nm_per_rad < curve.K2_Nm_per_rad < curve.K3_Nm_per_rad
    torque, angle = np.array(curve.torque_Nm), np.array(curve.angle_arcsec)
    order = np.argsort(torque, kind="stable")
    assert (
        np.diff(angle[order]).min() > -1e-3
    )  # loading and unloading settle to 1e-9 of the largest gap
    assert angle[order] == pytest.approx(-angle[order][::-1], abs=1e-4)
    # rated to T2 is K3's chord
    rad = np.radians(np.interp([10.0, 20.0], torque[:UP], angle[:UP]) / 3600)
    assert 10.0 / np.diff(rad)[0] == pytest.approx(curve.K3_Nm_per_rad)


def test_lost_motion_holds_the_clearance_of_the_flanks(curve: GearCurve) -> None:
    """j_bn0/(r_p cos α) of a bearing without play; play and wind-up come on top."""
    flanks = flexspline.backlash(DESIGN, K_b=1e9, K_e=1e9).flank_clearance_arcsec
    assert curve.lost_motion_arcsec > flanks
    tight = {"bearing.radial_clearance_um": 0.0, "gear.flank_clearance_um": 0.0}
    assert alone(DESIGN.changed(tight)).lost_motion_arcsec < curve.lost_motion_arcsec


def test_what_is_stated_is_not_assumed(curve: GearCurve) -> None:
    of_the_file = [a for a in curve.assumed if "." in a.key]
    assert [a.key for a in of_the_file] == [
        "gear.circular_spline_diameter_mm", "gear.working_depth_mm",
        *(f"wave_generator.{key}" for key in (
            "deflection_mm", "race_thickness_mm", "ball_diameter_mm", "ball_count")),
        "material.circular_spline.youngs_modulus_GPa", "material.bearing.youngs_modulus_GPa",
    ]  # fmt: skip
    stated = DESIGN.changed(
        {a.key: a.value for a in of_the_file if not a.key.startswith("material.")}
        | {
            "material.circular_spline": STEEL,
            "material.bearing": STEEL | {"youngs_modulus_GPa": 208.0},
        }
    )
    assert gear_assumptions(stated) == ()
    same = alone(stated)
    assert same.K1_Nm_per_rad == pytest.approx(curve.K1_Nm_per_rad, rel=1e-6)
    assert same.assumed == LAWS  # what no key states


def test_teeth_that_press_without_torque_are_said_with_the_reason() -> None:
    """A plug whose stroke is no m(z2 - z1)/2 leaves the teeth where both flanks touch."""
    short = flexspline.gear(DESIGN.changed({"wave_generator.deflection_mm": 0.13}))
    assert short.preload_tooth_force_N > 0
    (line,) = gear_warnings(short)
    assert "press on both flanks" in line
    assert "the plug's stroke of 0.13 mm is not m(z2 - z1)/2 = 0.2 mm" in line


def test_a_gear_that_is_softer_at_larger_torque_says_so(curve: GearCurve) -> None:
    """Teeth that press on both flanks are two springs side by side until one flank is free."""
    tight = {"wave_generator.deflection_mm": 0.215, "bearing.radial_clearance_um": 0.0}
    pressed = alone(DESIGN.changed(tight))
    assert pressed.K2_Nm_per_rad < 0.98 * pressed.K1_Nm_per_rad
    (line,) = (line for line in gear_notes(pressed) if "softer at larger torque" in line)
    fall_pct = 100 * (1 - pressed.K2_Nm_per_rad / pressed.K1_Nm_per_rad)
    assert line.startswith(f"K2 is {fall_pct:.2g} % below K1")
    assert "both flanks press without torque" in line
    assert not any("softer" in line for line in gear_notes(curve))


def test_the_gear_as_drawn_is_free_without_torque(curve: GearCurve) -> None:
    assert curve.preload_tooth_force_N == 0
    assert curve.warnings == ()
    assert any("instead of 23" in line for line in gear_notes(curve))


def test_the_free_angle_does_not_hang_on_the_load() -> None:
    """Its parts are those of the gear without torque, whatever torque the backlash is asked at."""
    small, large = (
        flexspline.gear(DESIGN.changed({"load.torque_Nm": torque})).terms_arcsec
        for torque in (0.5, 50.0)
    )
    for term in ("flank_clearance", "bearing_play", "tight_gear"):
        # a gap is taken at a thousandth of load or rated torque, where Hertz's contacts have yielded a little
        assert small[term] == pytest.approx(large[term], abs=0.2)
    assert large["flexspline"] > 50 * small["flexspline"] / 3


def test_files(curve: GearCurve, tmp_path: Path) -> None:
    write_gear(tmp_path, curve, {})
    with (tmp_path / "torque_angle.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(curve.torque_Nm)
    assert float(rows[UP - 1]["torque_Nm"]) == pytest.approx(20.0)
    assert float(rows[UP - 1]["angle_arcsec"]) == pytest.approx(curve.angle_arcsec[UP - 1])
    assert {p.name for p in tmp_path.iterdir()} == {
        "torque_angle.csv", "gear_torque_angle.png", "gear_loads.png", "gear.json"}  # fmt: skip


def test_the_curve_is_dense_where_the_lost_motion_lies(curve: GearCurve) -> None:
    """Its torque is a row, with as many below it and some up to T1; and the row says what the figure says."""
    up = curve.torque_Nm[:UP]
    at = up.index(pytest.approx(curve.lost_motion_torque_Nm))
    assert at >= 3
    assert sum(curve.lost_motion_torque_Nm < torque < 0.99 * curve.T1_Nm for torque in up) >= 2
    assert 2 * curve.angle_arcsec[at] == pytest.approx(curve.lost_motion_arcsec)


def test_t1_has_all_its_digits() -> None:
    """0.15 of 67 N·m."""
    assert quantity("T1_Nm").with_unit(10.05) == f"10.05{THIN}N·m"


def test_the_command_prints_the_figures_and_what_it_assumed(tmp_path: Path) -> None:
    path = tmp_path / "cup.toml"
    path.write_text(design_text(DESIGN), encoding="utf-8")
    ended = in_process.flexspline("gear", path, "--json", folder=tmp_path)
    assert ended.status == 0
    record = json.loads(ended.stdout)
    assert record == json.loads((tmp_path / "cup.out" / "gear.json").read_text(encoding="utf-8"))
    assert record["rated_torque_Nm"] == 20.0
    shown = table(record, tmp_path)
    assert "K1 of the whole gear, from 0 to T1" in shown
    assert "assumed: wave_generator.ball_count = 23" in shown


def test_terms_and_lost_motion_say_their_torques(curve: GearCurve, tmp_path: Path) -> None:
    """4 % of 20 N·m is 0.8; the design's load is 0.5."""
    record = gear_record(DESIGN, curve, Stiffnesses({}), 1.0)
    assert record["lost_motion_torque_Nm"] == pytest.approx(0.8)
    assert record["terms_torque_Nm"] == 0.5
    terms = record["terms_arcsec"]
    free = terms["flank_clearance"] + terms["bearing_play"] + terms["tight_gear"]
    assert record["free_angle_arcsec"] == pytest.approx(free)
    lines = table(record, tmp_path).splitlines()
    (said,) = (i for i, line in enumerate(lines) if "Twist between ± 0.5 N·m" in line)
    shown = [line.split()[-2:] for line in lines[said + 1 : said + 7]]
    assert [unit for _, unit in shown] == ["arcsec"] * 6
    # each is rounded to 0.05
    assert sum(float(v) for v, _ in shown[:-1]) == pytest.approx(float(shown[-1][0]), abs=0.3)
    assert any("Free angle" in line for line in lines)
    assert any("the lost motion at 0.8 N·m" in note for note in gear_notes(curve))


def test_terms_at_the_torque_of_the_lost_motion_need_no_word() -> None:
    same = flexspline.gear(DESIGN.changed({"load.torque_Nm": 0.8}))
    assert not any("the lost motion at" in note for note in gear_notes(same))
    # and add up to it: both are the twist between ± 0.8 N·m; the curve's chord begins elsewhere by rounding
    assert same.terms_arcsec["total"] == pytest.approx(same.lost_motion_arcsec, rel=1e-6)


def test_stiffness_is_printed_to_four_digits_and_kept_whole(
    curve: GearCurve, tmp_path: Path
) -> None:
    strong = {"K1_Nm_per_rad": 123456.7, "design": "a gear"}
    assert "123\u202f500 N·m/rad" in table(strong, tmp_path)
    assert gear_record(DESIGN, curve, Stiffnesses({}), 1.0)["K3_Nm_per_rad"] == curve.K3_Nm_per_rad


def test_a_wrong_file_is_refused_with_status_2(tmp_path: Path) -> None:
    path = tmp_path / "cup.toml"
    text = design_text(DESIGN).replace("[load]", "[wave_generator]\nball_count = 2\n[load]")
    path.write_text(text, encoding="utf-8")
    ended = in_process.flexspline("gear", path, folder=tmp_path)
    assert ended.status == 2
    assert len(ended.stderr.splitlines()) == 1
    assert "wave_generator.ball_count" in ended.stderr
    assert ended.written == frozenset()


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"wave_generator.deflection_mm": 0.02}, "must be from 0.1 to 0.3 mm"),
        ({"wave_generator.race_thickness_mm": 9.0}, "must be from 0.192 to 4.8 mm"),
        ({"wave_generator.race_thickness_mm": 0.001}, "0.01 to 0.25 of the tube's inner radius"),
        ({"wave_generator.ball_diameter_mm": 0.001}, "must be from 0.192 to 12.28 mm"),
        ({"wave_generator.ball_count": 40, "wave_generator.ball_diameter_mm": 3.8}, "40 balls"),
        ({"wave_generator.ball_count": 3}, "from 6 to 200"),
        ({"gear.rated_torque_Nm": 0.0}, "rated_torque_Nm"),
        ({"gear.rated_torque_Nm": 1e-6}, "must be from 0.0232 to 2320 N·m"),
    ],
)
def test_what_cannot_be_built_is_refused_in_one_line(changes: dict, says: str) -> None:
    with pytest.raises(flexspline.FlexsplineError, match=says) as fault:
        DESIGN.changed(changes)
    assert "\n" not in str(fault.value)


def test_the_range_that_is_told_works() -> None:
    crowd = {"wave_generator.ball_count": 40}
    with pytest.raises(flexspline.FlexsplineError) as fault:
        DESIGN.changed({**crowd, "wave_generator.ball_diameter_mm": 3.8})
    largest = float(str(fault.value).split(" mm: 40 balls")[0].split()[-1])
    assert DESIGN.changed({**crowd, "wave_generator.ball_diameter_mm": largest})


THINNEST = {"wave_generator.race_thickness_mm": 0.192}
SMALLEST = {"wave_generator.ball_diameter_mm": 0.192}


@pytest.mark.parametrize("balls", [pytest.param(6, marks=pytest.mark.long), 200])
def test_the_thinnest_race_and_the_smallest_balls_still_have_a_curve(balls: int) -> None:
    """Softer than the gear with a usual race, as a part in its chain of springs is."""
    found = alone(DESIGN.changed({**THINNEST, **SMALLEST, "wave_generator.ball_count": balls}))
    usual = alone(DESIGN.changed({"wave_generator.ball_count": balls}))
    assert np.diff(found.angle_arcsec[:UP]).min() > 0
    assert found.K3_Nm_per_rad < usual.K3_Nm_per_rad


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        # w0 of 0.1 · 19.2 mm, in steps of m = 0.2: 9 more pairs of teeth
        ({"gear.teeth_circular_spline": 220}, "must be at most 218"),
        ({"gear.teeth_circular_spline": 400}, "must be at most 218"),
        # ring of 19.75 mm: m(100 + 1) beyond it, m(100 - 1.25 - 2.25) within
        ({"gear.module_mm": 0.4}, "must be from 0.1956 to 0.2046 mm"),
        # its stroke of 2 mm is too much as well, for the module alone
        (
            {"gear.module_mm": 2.0, "gear.rated_torque_Nm": 100.0},
            "gear.module_mm = 2.0: must be from 0.1956 to 0.2046 mm",
        ),
        (
            {"gear.module_mm": 0.1, "bearing.radial_clearance_um": 10.0},
            "must be from 0.1956 to 0.2046 mm",
        ),
        (
            {"gear.teeth_flexspline": 160, "gear.teeth_circular_spline": 162},
            "160 teeth of that module do not stand on the ring",
        ),
    ],
)
def test_what_is_no_whole_gear_is_refused_with_the_range(changes: dict, says: str) -> None:
    with pytest.raises(flexspline.FlexsplineError, match=says):
        flexspline.gear(DESIGN.changed(changes))


@pytest.mark.long
def test_the_most_teeth_and_the_ends_of_the_module_are_gears() -> None:
    most = {"gear.teeth_circular_spline": 218}
    for changes in (most, {"gear.module_mm": 0.1956}, {"gear.module_mm": 0.2046}):
        assert alone(DESIGN.changed(changes)).K3_Nm_per_rad > 0


def test_a_clearance_that_leaves_no_tooth_is_refused() -> None:
    """π m/2 cos α = 295.2 µm of m = 0.2 mm at 20°."""
    with pytest.raises(flexspline.FlexsplineError, match=r"from 0 to 295\.2 µm"):
        DESIGN.changed({"gear.flank_clearance_um": 295.3})
    assert DESIGN.changed({"gear.flank_clearance_um": 295.2})


def test_play_beyond_the_stroke_is_refused() -> None:
    loose = DESIGN.changed(
        {"bearing.bearing_play_model": "small_displacement", "bearing.radial_clearance_um": 400.0}
    )
    with pytest.raises(flexspline.FlexsplineError, match="must be below 400 µm"):
        flexspline.gear(loose)


def test_the_command_leaves_a_run_s_result_alone(curve: GearCurve, tmp_path: Path) -> None:
    path, out = tmp_path / "cup.toml", tmp_path / "out"
    path.write_text(design_text(DESIGN), encoding="utf-8")
    out.mkdir()
    (out / "result.json").write_text("of a run")
    done = in_process.flexspline("gear", path, "--out", out, "--json", folder=tmp_path)
    assert done.status == 0, done.stderr
    assert (out / "result.json").read_text() == "of a run"
    assert json.loads(done.stdout) == json.loads((out / "gear.json").read_text())
    assert json.loads(done.stdout)["K2_Nm_per_rad"] == pytest.approx(curve.K2_Nm_per_rad)


@pytest.mark.parametrize("rated_Nm", [0.0232, 2320.0])
def test_the_ends_of_rated_torque_still_have_a_curve(rated_Nm: float) -> None:
    found = alone(DESIGN.changed({"gear.rated_torque_Nm": rated_Nm}))
    assert 0 < found.K1_Nm_per_rad < 1e6
    assert 0 < found.K3_Nm_per_rad < 1e6
    up = np.array(found.angle_arcsec[:UP])
    assert np.diff(up).min() > 0


def test_the_ratcheting_torque_is_an_upper_limit(curve: GearCurve) -> None:
    """Far beyond any catalogue's, 5 to 10 times rated torque, and said to be so."""
    assert curve.ratcheting_torque_Nm is not None
    assert curve.ratcheting_torque_Nm > 10 * curve.rated_torque_Nm
    assert any("upper limit" in line for line in gear_notes(curve))


def test_straight_teeth_touch_at_the_open_end_first(curve: GearCurve) -> None:
    """Less lost motion by the cone's part of the clearance, and no word of a relief."""
    straight = alone(DESIGN.changed({"gear.tooth_face": "straight"}))
    assert straight.lost_motion_arcsec < curve.lost_motion_arcsec - 30
    assert any("deforms to a cone" in line for line in gear_notes(curve))
    assert not any("deforms to a cone" in line for line in gear_notes(straight))


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [
        ("working_depth_mm", 0.3, "to 0.2682 mm"),
        ("circular_spline_diameter_mm", 40.0, "the root circle's diameter"),
        ("tooth_face", "crowned", "relieved"),
    ],
)
def test_a_circular_spline_that_cannot_be_is_refused(key: str, value: object, says: str) -> None:
    with pytest.raises(flexspline.FlexsplineError, match=says):
        DESIGN.changed({f"gear.{key}": value})


def test_a_rated_torque_that_the_teeth_do_not_hold_is_warned_of(curve: GearCurve) -> None:
    """The ratcheting torque does not depend on the rated torque that is stated."""
    assert curve.ratcheting_torque_Nm is not None
    beyond = 1.2 * curve.ratcheting_torque_Nm
    strong = flexspline.gear(DESIGN.changed({"gear.rated_torque_Nm": beyond}))
    assert strong.ratcheting_torque_Nm == curve.ratcheting_torque_Nm
    assert any("below the rated torque" in line for line in gear_warnings(strong))


def test_a_clearance_that_makes_the_gap_smaller_is_explained() -> None:
    """A plug whose stroke is a little short: play and stroke act together."""
    short = flexspline.gear(DESIGN.changed({"wave_generator.deflection_mm": 0.189}))
    negative = short.terms_arcsec["bearing_play"] < 0
    assert negative == any(
        "bearing_play and tight_gear only together" in n for n in gear_notes(short)
    )
    assert negative


def test_the_tube_of_the_example_buckles_beyond_what_its_teeth_carry(curve: GearCurve) -> None:
    """0.67 of Donnell's hinged tube, 1176 N·m by hand: r 19.4, t 0.4, L 21.25 mm."""
    # two digits are printed
    assert curve.buckling_torque_Nm == pytest.approx(0.67 * 1176, rel=0.02)
    strong = flexspline.gear(DESIGN.changed({"gear.rated_torque_Nm": 900.0}))
    assert any("tube buckles" in line for line in gear_warnings(strong))
    assert not any("tube buckles" in line for line in gear_warnings(curve))


def test_a_material_of_the_gear_needs_its_modulus_alone(curve: GearCurve) -> None:
    """One key makes the table, as a study varies it; what nothing reads is refused."""
    softer = DESIGN.changed({"material.bearing.youngs_modulus_GPa": 104.0})
    assert alone(softer).K1_Nm_per_rad < curve.K1_Nm_per_rad
    with pytest.raises(flexspline.FlexsplineError, match="fatigue_limit_MPa"):
        DESIGN.changed({"material.circular_spline": {**STEEL, "fatigue_limit_MPa": 500.0}})


def low_ratio(play_um: float) -> GearCurve:
    """A gear of ratio 30, whose rim stands low with much play; its shaft without holes, as `DESIGN`'s."""
    sized = design_from(tomllib.loads(sized_template("cup", 25, 30)))
    return flexspline.gear(
        sized.changed({"shaft.bolt_count": 0, "bearing.radial_clearance_um": play_um})
    )


def test_play_that_closes_the_gap_is_warned_of() -> None:
    """From 95 to 116 µm the lost motion falls; from 0 to 32 it grows."""
    loose, looser, tight = (low_ratio(play) for play in (95.0, 116.0, 32.0))
    assert looser.lost_motion_arcsec < loose.lost_motion_arcsec
    for found in (loose, looser):
        assert any("reduce the play" in line for line in gear_warnings(found))
    assert not any("reduce the play" in line for line in gear_warnings(tight))
    assert any("play interact" in line for line in gear_notes(tight))
    assert any("below a ratio of 45" in line for line in gear_notes(tight))


def test_materials_of_the_other_parts_count(curve: GearCurve) -> None:
    """Aluminium races make K1 softer, a circular spline of it a little; what is stated is not assumed."""
    aluminium = {"name": "EN AW-7075", "youngs_modulus_GPa": 71.0, "poissons_ratio": 0.33}
    for key, least in (("bearing", 0.7), ("circular_spline", 0.8)):
        found = alone(DESIGN.changed({f"material.{key}": aluminium}))
        assert least < found.K1_Nm_per_rad / curve.K1_Nm_per_rad < 0.99
        assert any(a.key.startswith(f"material.{key}.") for a in curve.assumed)
        assert not any(a.key.startswith(f"material.{key}.") for a in found.assumed)


def test_teeth_of_two_materials_yield_as_the_mean_of_both() -> None:
    """Two springs in series: compliance is linear in each one's 1/E."""
    soft = {"name": "half", "youngs_modulus_GPa": 103.0, "poissons_ratio": 0.3}
    one = pair_compliance(DESIGN)
    assert pair_compliance(DESIGN.changed({"material.circular_spline": soft})) == pytest.approx(
        1.5 * one
    )
