"""Warnings carry the numbers that explain them; usual designs have none."""

from __future__ import annotations

import re

import pytest
from example_files import EXAMPLES

from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import load_design
from flexspline.geometry.sanity import ring_bending_stress_MPa, warnings
from flexspline.geometry.whole_gear import require_whole_gear

CASES = {
    # ring 0.7: Rr = 19.9 against 0.2(100 − 1.25) = 19.75
    "flexspline.ring_thickness_mm": (
        0.7,
        ("19.75", "19.9", "differ by 0.15 mm", "0.03 mm", "= 0.55 would fit"),
    ),
    # root 0.194(100 − 1.25) = 19.16 inside the tube of 38.4 mm
    "gear.module_mm": (0.194, ("19.16", "inside the tube", "19.2 mm", "gear.module_mm")),
    "flexspline.wall_thickness_mm": (0.15, ("0.15 / 38.4 = 0.00391", "0.005 to 0.025")),
    "flexspline.length_mm": (60.0, ("60 / 38.4 = 1.56", "0.2 to 1.4")),
    "flexspline.outer_fillet_mm": (2.6, ("outer_fillet_mm = 2.6", "half of 0.4 mm")),
    "flexspline.boss_thickness_mm": (25.0, ("boss_thickness_mm = 25", "z = 22 mm")),
    "flexspline.bolt_circle_diameter_mm": (14.0, ("= 14", "shaft", "= 13")),
    "material.flexspline.fatigue_limit_MPa": (90.0, ("98 MPa", "= 90")),
    "shaft.grip_length_mm": (25.0, ("= 25", "last segment, 24 mm", "only 3 of 28 mm")),
    "gear.flank_clearance_um": (0.003, ("flank_clearance_um = 0.003", "in mm?")),
    "bearing.radial_clearance_um": (0.012, ("radial_clearance_um = 0.012", "in mm?")),
    "uncertainty.radial_clearance_um": (7.0, ("12 ± 7", "24.12 µm")),
}


@pytest.mark.parametrize("key", CASES)
def test_unusual_value_is_warned_of_with_numbers(key: str) -> None:
    value, says = CASES[key]
    lines = warnings(load_design(EXAMPLES / "xb1-40.toml").changed({key: value}))
    assert len(lines) == 1
    for words in says:
        assert words in lines[0]


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [
        # a tooth is 0.2 π/2 = 314.2 µm thick
        ("gear.flank_clearance_um", 60.0, ("= 60", "19 %", "314.2 µm")),
        # stress stays below the fatigue limit of 500 MPa up to 5 pairs of teeth
        ("gear.teeth_circular_spline", 210, ("200/10 = 20", "usually 30 or more")),
        # 19.2 mm inside the tube
        ("wave_generator.ball_diameter_mm", 1.0, ("= 1", "0.0521", "0.1 to 0.35")),
    ],
)
def test_what_hardly_any_gear_has_is_warned_of(key: str, value: float, says: tuple[str]) -> None:
    (line,) = warnings(load_design(EXAMPLES / "xb1-40.toml").changed({key: value}))
    for words in says:
        assert words in line


def test_no_ring_thinner_than_the_wall_is_advised() -> None:
    """Wall 0.6 and a ring of 0.7 mm: one of 0.55, the root less the inner radius, would be no ring.

    The tube would fit at 2(19.75 − 0.7).
    """
    thick = {"flexspline.wall_thickness_mm": 0.6, "flexspline.ring_thickness_mm": 0.7}
    design = load_design(EXAMPLES / "xb1-40.toml").changed(thick)
    (line,) = (w for w in warnings(design) if "tooth-root" in w)
    assert line.endswith("; flexspline.inner_diameter_mm = 38.1 would fit")


@pytest.mark.parametrize("example", ["xb1-40", "hat-25", "keyed-shaft"])
def test_examples_have_no_warning(example: str) -> None:
    assert warnings(load_design(EXAMPLES / f"{example}.toml")) == ()


def test_ring_bending_stress_by_hand() -> None:
    # 206e3/0.91 · 0.275 · 3 · 0.2 / 19.475²
    stress = ring_bending_stress_MPa(load_design(EXAMPLES / "xb1-40.toml"))
    assert stress == pytest.approx(98.48, abs=0.01)  # to the digits worked out


@pytest.mark.parametrize("module", [2.0, 0.02])
def test_a_module_ten_times_off_is_said_and_no_ring_of_178_mm_is_proposed(module: float) -> None:
    """0.2 mm belongs to 200 teeth on a ring of 39.5 mm: 19.75 = 0.2(100 − 1.25)."""
    slip = {"gear.module_mm": module, "bearing.radial_clearance_um": 1.0}
    design = load_design(EXAMPLES / "xb1-40.toml").changed(slip)
    (line,) = (t for t in warnings(design) if "tooth-root" in t)
    assert "gear.module_mm" in line
    assert "it is 0.2" in line
    assert "would fit" not in line


def test_a_diameter_in_metres_is_refused() -> None:
    """A hat's holes lie outside its tube, so that nothing else refuses it."""
    hat = load_design(EXAMPLES / "hat-25.toml")
    inner_mm = hat.flexspline.inner_diameter_mm
    with pytest.raises(DesignError, match="it looks like metres") as refused:
        hat.changed({"flexspline.inner_diameter_mm": inner_mm / 1000})
    assert refused.value.key == "flexspline.inner_diameter_mm"
    assert refused.value.reason.endswith(f" {inner_mm:g} mm")
    low, high = (float(x) for x in re.findall(r"from (\S+) to (\S+) mm", str(refused.value))[0])
    assert low < inner_mm < high
    flange = {"flange_inner_diameter_mm": 2 * high, "flange_outer_diameter_mm": 3 * high}
    for at_the_end in (1.001 * low, 0.999 * high):
        tube = {"inner_diameter_mm": at_the_end, "bolt_count": 0}
        hat.changed({f"flexspline.{key}": value for key, value in {**flange, **tube}.items()})


@pytest.mark.parametrize("inner_mm", [0.03, 0.1, 0.3, 0.6])
def test_a_tube_narrower_than_the_plugs_stroke_is_refused(inner_mm: float) -> None:
    """w0 = 0.3 mm moves a wall of 0.3 mm radius to the axis; such a hat took 90 s, for 1 429 926 MPa."""
    hat = load_design(EXAMPLES / "hat-25.toml")
    with pytest.raises(DesignError, match=r"stroke of 0\.3 mm is no less than") as refused:
        hat.changed({"flexspline.inner_diameter_mm": inner_mm})
    assert refused.value.key == "flexspline.inner_diameter_mm"
    assert not refused.value.others
    low, high = (float(x) for x in re.findall(r"from (\S+) to (\S+) mm", str(refused.value))[0])
    assert low < hat.flexspline.inner_diameter_mm < high


def test_a_wrong_diameter_says_nothing_of_play_and_clearance() -> None:
    """They fit the module, which is the hat's own; the ring's would be 0.016 mm."""
    hat = load_design(EXAMPLES / "hat-25.toml")
    lines = warnings(hat.changed({"flexspline.inner_diameter_mm": 1.5}))
    assert "does not belong to this ring" in lines[0]
    assert not any("clearance_um" in line for line in lines)


def test_a_ring_too_small_for_any_module_is_told_a_diameter() -> None:
    """200 teeth of 0.001 mm stand on a ring from m(100 - 1.25 - 2.25) = 0.0965 mm on, 2 µm of them wall."""
    small = {
        "inner_diameter_mm": 0.06, "wall_thickness_mm": 0.001, "ring_thickness_mm": 0.001,
        "length_mm": 0.03, "ring_width_mm": 0.01, "ring_offset_mm": 0.001, "diaphragm_thickness_mm": 0.001,
        "flange_inner_diameter_mm": 0.08, "flange_outer_diameter_mm": 0.1, "flange_thickness_mm": 0.004,
        "inner_fillet_mm": 0.001, "outer_fillet_mm": 0.001, "bolt_count": 0,
    }  # fmt: skip
    hat = load_design(EXAMPLES / "hat-25.toml").changed({
        **{f"flexspline.{key}": value for key, value in small.items()},
        "gear.module_mm": 0.001,
        "gear.flank_clearance_um": 0.0,
        "bearing.radial_clearance_um": 0.0,
    })  # fmt: skip
    assert "it is 0.00031, less than any may be (0.001 mm)" in warnings(hat)[0]
    with pytest.raises(DesignError, match=r"inner_diameter_mm = 0\.06: must be at least 0\.191 mm"):
        require_whole_gear(hat)


@pytest.mark.parametrize("clearance_um", [12.0, 60.0])
def test_a_play_refused_for_a_slipped_module_is_the_modules_fault(clearance_um: float) -> None:
    """At its 0.02 mm the play ends at 2.4 µm; by the 0.2 mm of the ring it is wrong beyond 24 µm."""
    cup = load_design(EXAMPLES / "xb1-40.toml")
    with pytest.raises(DesignError) as refused:
        cup.changed({"gear.module_mm": 0.02, "bearing.radial_clearance_um": clearance_um})
    assert refused.value.key == "gear.module_mm"
    assert f"no gear of that size has bearing.radial_clearance_um = {clearance_um:g}" in str(
        refused.value
    )
    others = [fault.key for fault in refused.value.others]
    assert others == (["bearing.radial_clearance_um"] if clearance_um > 24.2 else [])


def test_a_slipped_module_warns_of_itself_alone() -> None:
    """Rated torque, play and clearance would be usual with the ring's module of 0.2 mm."""
    cup = load_design(EXAMPLES / "xb1-40.toml").changed({"gear.rated_torque_Nm": 23.0})
    assert not warnings(cup)
    (line,) = warnings(cup.changed({"gear.module_mm": 0.1, "gear.flank_clearance_um": 20.0}))
    assert "gear.module_mm = 0.1 does not belong to this ring" in line
