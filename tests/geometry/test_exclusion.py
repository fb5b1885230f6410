"""The stress rule's distance: each part's own, one wall thickness where walls are thin."""

from __future__ import annotations

import pytest
from changed_design import EXAMPLES, changed_design, shaft_of

from flexspline.geometry.exclusion import exclusion_mm
from flexspline.geometry.load import load_design


def test_a_flexsplines_is_its_wall() -> None:
    design = changed_design("xb1-40", {"flexspline.wall_thickness_mm": "0.45"})
    assert exclusion_mm(design.flexspline) == 0.45


@pytest.mark.parametrize("wall", ["0.25", "0.45", "0.55"])
def test_a_shafts_does_not_move_with_the_flexsplines_wall(wall: str) -> None:
    plain = load_design(EXAMPLES / "xb1-40.toml")
    changed = changed_design("xb1-40", {"flexspline.wall_thickness_mm": wall})
    assert exclusion_mm(changed.shaft) == exclusion_mm(plain.shaft)


def test_a_thin_shafts_is_its_thinnest_wall_and_a_thick_ones_a_share_of_its_radius() -> None:
    # segments as (length, outer, inner): walls of 4 and 0.3 mm, least outer radius 10 mm
    thin = shaft_of([(10.0, 24.0, 16.0), (10.0, 20.0, 19.4)], fillet=0.1)
    assert exclusion_mm(thin.shaft) == pytest.approx(0.3)
    thick = shaft_of([(10.0, 24.0, 0.0), (10.0, 20.0, 0.0)])
    assert exclusion_mm(thick.shaft) == pytest.approx(0.5)
