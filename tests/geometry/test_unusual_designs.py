"""Unusual but possible designs are accepted, and the CAD kernel builds them as they should be."""

from __future__ import annotations

from pathlib import Path

import pytest
from cad_volume import assert_volume
from changed_text import changed_text
from example_files import EXAMPLES
from shaft_of import shaft_of

from flexspline.geometry.cad import build_solid
from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design

FLEXSPLINES = {
    "no holes": ("xb1-40", {"bolt_count": "0"}),
    "no holes, keys gone": (
        "xb1-40",
        {"bolt_count": "0", "bolt_circle_diameter_mm": None, "bolt_hole_diameter_mm": None},
    ),
    "one hole": ("xb1-40", {"bolt_count": "1"}),
    "two holes": ("xb1-40", {"bolt_count": "2"}),
    "one hole over the axis": (
        "xb1-40",
        {"bolt_count": "1", "bore_diameter_mm": "0", "bolt_circle_diameter_mm": "1.0"},
    ),
    "most holes": ("xb1-40", {"bolt_count": "16"}),
    "no bore": ("xb1-40", {"bore_diameter_mm": "0"}),
    "bore key gone": ("xb1-40", {"bore_diameter_mm": None}),
    "ring offset": ("xb1-40", {"ring_offset_mm": "4.0"}),
    "ring as thick as the wall": ("xb1-40", {"ring_thickness_mm": "0.40"}),
    "the same, offset": ("xb1-40", {"ring_thickness_mm": "0.40", "ring_offset_mm": "4.0"}),
    "sharp corners": ("xb1-40", {"inner_fillet_mm": "0", "outer_fillet_mm": "0.0"}),
    "boss as thin as the diaphragm": ("xb1-40", {"boss_thickness_mm": "0.6"}),
    "diaphragm as thick as the boss": ("xb1-40", {"diaphragm_thickness_mm": "3.0"}),
    "largest inner fillet": ("xb1-40", {"inner_fillet_mm": "10.2"}),
    "boss up to the fillet": ("xb1-40", {"boss_diameter_mm": "36.4"}),
    "ring down to the fillet": ("xb1-40", {"ring_width_mm": "28.4"}),
    "boss taller than the ring": ("xb1-40", {"boss_thickness_mm": "29.0"}),
    "fillets with a thin web": ("xb1-40", {"outer_fillet_mm": "2.6"}),
    "whole numbers": ("xb1-40", {"length_mm": "30", "inner_fillet_mm": "1"}),
    "hat, thin flange": ("hat-25", {"flange_thickness_mm": "0.5"}),
    "hat, flange up to the fillet": ("hat-25", {"flange_inner_diameter_mm": "61.6"}),
    "hat, sharp corners": ("hat-25", {"inner_fillet_mm": "0", "outer_fillet_mm": "0"}),
    "hat, no holes": ("hat-25", {"bolt_count": "0"}),
    "hat, no ring offset": ("hat-25", {"ring_offset_mm": None}),
}


@pytest.mark.parametrize(("example", "changes"), FLEXSPLINES.values(), ids=FLEXSPLINES)
def test_unusual_flexspline(example: str, changes: dict[str, str | None], tmp_path: Path) -> None:
    path = tmp_path / "unusual.toml"
    text = changed_text(example, {f"flexspline.{k}": v for k, v in changes.items()})
    path.write_text(text, encoding="utf-8")
    assert_volume(load_design(path), "flexspline")


STEPS = [(4.0, 20.0, 6.0), (5.0, 17.0, 4.0), (6.0, 21.0, 15.0), (7.0, 18.0, 0.0)]
HOLES = "bolt_count = 6\nbolt_circle_diameter_mm = 13.0\nbolt_hole_diameter_mm = 2.5"
SHAFTS = {
    "one segment": shaft_of([(20.0, 20.0, 6.0)]),
    "one solid segment": shaft_of([(20.0, 20.0, 0.0)]),
    "one segment, holes through": shaft_of([(20.0, 20.0, 6.0)], HOLES),
    "two equal segments": shaft_of([(20.0, 20.0, 0.0), (20.0, 20.0, 0.0)]),
    "up and down, bores of all sizes": shaft_of(STEPS),
    "the same, sharp": shaft_of(STEPS, fillet=0.0),
    "fillet as high as the step": shaft_of(STEPS, fillet=1.5),
    "grip over three segments": shaft_of(STEPS, "grip_length_mm = 15.0"),
    "grip from a step": shaft_of(STEPS, "grip_length_mm = 13.0"),
    "grip from a fillet's end": shaft_of(STEPS, "grip_length_mm = 6.5"),
    "grip almost to the flange's face": shaft_of(STEPS, "grip_length_mm = 21.0"),
    "segment made of two fillets": shaft_of([(4, 20, 6), (1, 16, 6), (9, 20, 6)]),
}


@pytest.mark.parametrize("design", SHAFTS.values(), ids=SHAFTS)
def test_unusual_shaft(design: Design) -> None:
    assert_volume(design, "shaft")


def test_keyway_into_the_flange_builds_one_solid() -> None:
    key = "[keyway]\nwidth_mm = 5.0\ndepth_mm = 3.0\nlength_mm = 26.0"
    design = shaft_of([(4.0, 20.0, 6.0), (24.0, 16.0, 6.0)], f"{HOLES}\n{key}")
    assert build_solid(design.part("shaft")).Volume() < design.part("shaft").meridian.volume


def test_small_displacement_model_has_no_play_limit() -> None:
    play = {
        "bearing.radial_clearance_um": 80.0,
        "bearing.bearing_play_model": "small_displacement",
    }
    design = load_design(EXAMPLES / "xb1-40.toml").changed(play)
    assert design.bearing.radial_clearance_um == 80.0


def test_play_at_its_limit_is_accepted() -> None:
    cup = load_design(EXAMPLES / "xb1-40.toml")
    limit = cup.gear.bearing_play_limit_um
    design = cup.changed({"bearing.radial_clearance_um": limit})
    assert design.bearing.radial_clearance_um == limit


def test_byte_order_mark_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "windows.toml"
    path.write_text("\ufeff" + changed_text("xb1-40", {}).replace("\n", "\r\n"), encoding="utf-8")
    assert load_design(path) == load_design(EXAMPLES / "xb1-40.toml")
