"""What follows from a part's shape and material; the stress rule's distance is each part's own."""

from __future__ import annotations

from dataclasses import replace

import pytest
from example_files import EXAMPLES
from shaft_of import shaft_of

from flexspline.geometry.keys import without_holes
from flexspline.geometry.load import load_design
from flexspline.geometry.shaft_shape import Shaft


def test_a_flexsplines_is_its_wall() -> None:
    design = load_design(EXAMPLES / "xb1-40.toml").changed({"flexspline.wall_thickness_mm": 0.45})
    assert design.part("flexspline").exclusion_mm == 0.45


@pytest.mark.parametrize("wall", [0.25, 0.45, 0.55])
def test_a_shafts_does_not_move_with_the_flexsplines_wall(wall: float) -> None:
    plain = load_design(EXAMPLES / "xb1-40.toml")
    changed = plain.changed({"flexspline.wall_thickness_mm": wall})
    assert changed.part("shaft").exclusion_mm == plain.part("shaft").exclusion_mm


def test_a_thin_shafts_is_its_thinnest_wall_and_a_thick_ones_a_share_of_its_radius() -> None:
    # segments as (length, outer, inner): walls of 4 and 0.3 mm, least outer radius 10 mm
    thin = shaft_of([(10.0, 24.0, 16.0), (10.0, 20.0, 19.4)], fillet=0.1)
    assert thin.part("shaft").exclusion_mm == pytest.approx(0.3)
    thick = shaft_of([(10.0, 24.0, 0.0), (10.0, 20.0, 0.0)])
    assert thick.part("shaft").exclusion_mm == pytest.approx(0.5)


@pytest.mark.parametrize("example", ["xb1-40", "hat-25"])
def test_a_part_is_turned_at_a_patch_of_its_meridian_and_held_at_mount(example: str) -> None:
    for part in load_design(EXAMPLES / f"{example}.toml").parts:
        assert {part.driven, "mount"} <= {s.patch for s in part.meridian.segments}


def test_holes_end_with_boss_flange_or_first_segment() -> None:
    cup, hat = (load_design(EXAMPLES / f"{name}.toml") for name in ("xb1-40", "hat-25"))
    assert cup.part("flexspline").hole_depth == cup.flexspline.boss_thickness_mm
    assert hat.part("flexspline").hole_depth == hat.flexspline.flange_thickness_mm
    assert cup.part("shaft").hole_depth == cup.shaft.segment[0].length_mm


def test_holes_or_a_keyway_keep_a_part_from_being_a_body_of_revolution() -> None:
    design = load_design(EXAMPLES / "xb1-40.toml")
    assert not any(part.is_revolved for part in design.parts)
    bare = without_holes(design)
    assert all(part.is_revolved for part in bare.parts)
    keyway = {"width_mm": 2.0, "depth_mm": 1.0, "length_mm": 5.0}
    assert not bare.changed({"shaft.keyway": keyway}).part("shaft").is_revolved


def test_a_shaft_without_a_material_has_the_flexsplines() -> None:
    design = load_design(EXAMPLES / "xb1-40.toml")
    materials = design.material.model_copy(update={"shaft": None})
    alone = design.model_copy(update={"material": materials})
    assert alone.part("shaft").material == design.material.flexspline


@pytest.mark.parametrize(
    ("slot_mm", "circle_mm", "hole_mm", "count", "meet"),
    [
        (25.0, 12.0, 2.0, 1, True),  # the hole is in the slot
        (20.0, 12.0, 2.0, 1, True),  # its floor is the slot's end
        (19.9, 12.0, 2.0, 1, False),  # 0.1 mm of material between them
        (25.0, 8.0, 1.9, 1, False),  # below the slot's floor: 4 + 0.95 mm
        (25.0, 8.0, 2.0, 1, True),  # touching it
        (25.0, 8.0, 1.9, 7, False),  # the others are farther from the slot
    ],
)
def test_holes_and_keyway_that_are_one_cut(
    slot_mm: float, circle_mm: float, hole_mm: float, count: int, meet: bool
) -> None:
    """A shaft of 40 mm in two pieces; the keyway's floor is at 5 mm, its width 5; holes are 20 mm deep."""
    bolts = {
        "bolt_count": count,
        "bolt_circle_diameter_mm": circle_mm,
        "bolt_hole_diameter_mm": hole_mm,
    }
    piece = {"length_mm": 20.0, "outer_diameter_mm": 16.0, "inner_diameter_mm": 0.0}
    part = load_design(EXAMPLES / "keyed-shaft.toml").part("shaft")
    shape = part.shape.model_dump() | bolts | {"segment": (piece, piece)}
    shape["keyway"]["length_mm"] = slot_mm
    assert replace(part, shape=Shaft.model_validate(shape)).cuts_meet is meet
    del shape["keyway"]
    assert not replace(part, shape=Shaft.model_validate(shape)).cuts_meet


def test_the_thinnest_material_beside_a_bolt_hole() -> None:
    cup = load_design(EXAMPLES / "xb1-40.toml")
    # six holes of 2.5 on 13 mm: 4 mm apart, 1.25 mm from the bore of 8 and from the boss of 18
    assert cup.part("flexspline").ligament_mm == pytest.approx(1.25)
    wide = cup.changed({"flexspline.bolt_hole_diameter_mm": 4.6, "flexspline.bolt_count": 8})
    assert wide.part("flexspline").ligament_mm == pytest.approx(0.2)
    # on a circle of 13 mm chords are 13 sin(π/8) = 4.975 mm
    close = wide.changed(
        {"flexspline.bolt_hole_diameter_mm": 4.9, "flexspline.bore_diameter_mm": 7.0}
    )
    assert close.part("flexspline").ligament_mm == pytest.approx(0.05)
    one = cup.changed({"flexspline.bolt_count": 1})
    assert one.part("flexspline").ligament_mm == pytest.approx(1.25)
    assert without_holes(cup).part("flexspline").ligament_mm == float("inf")
