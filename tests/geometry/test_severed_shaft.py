"""A single hole over the axis may not be so large that what stands on the flange is cut off.

The shaft: a flange of 20 mm, solid, 4 mm thick, and a segment of 9 mm on it. The hole, as deep as the flange,
holds the whole root where its radius is the root's and the distance of the two axes together, or more.
"""

from __future__ import annotations

import re
from math import pi

import pytest
from shaft_of import shaft_of

from flexspline.geometry.cad import build_solid
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError


def pierced(circle: str, hole: str, fillet: float = 0.0, second: float = 9.0) -> Design:
    holes = f"bolt_count = 1\nbolt_circle_diameter_mm = {circle}\nbolt_hole_diameter_mm = {hole}"
    return shaft_of([(4.0, 20.0, 0.0), (24.0, second, 0.0)], holes, fillet)


@pytest.mark.parametrize("fillet", [0.0, 0.05, 0.5])
@pytest.mark.parametrize(
    ("circle", "hole", "key"),
    [
        ("0.5", "12.0", "shaft.bolt_circle_diameter_mm = 0.5"),
        ("0.5", "25.0", "shaft.bolt_hole_diameter_mm = 25.0"),
    ],
)
def test_it_is_refused_and_both_ends_of_the_range_can_be_built(
    circle: str, hole: str, key: str, fillet: float
) -> None:
    with pytest.raises(DesignError) as caught:
        pierced(circle, hole, fillet)
    line = str(caught.value)
    assert line.startswith(f"{key}: must be from ")
    assert "and do not cut off the next segment" in line
    found = re.search(r"from ([\d.]+) to ([\d.]+) mm", line)
    assert found is not None
    for end in found.groups():
        changed = (end, hole) if "circle" in key else (circle, end)
        solid = build_solid(pierced(*changed, fillet).part("shaft"))  # raises of two solids
        assert solid.Volume() > 0


@pytest.mark.parametrize(
    ("circle", "fillet", "stands"),
    [
        # by hand: 12/2 − 9/2 = 1.5 from axis to axis, so a circle of 3 mm
        ("2.99", 0.0, False),
        ("3.01", 0.0, True),
        # the fillet's foot is 0.5 mm beyond the root: a circle of 2 mm, with 0.001 mm of it left 2.066
        ("2.0", 0.5, False),
        ("2.07", 0.5, True),
    ],
)
def test_the_limit_is_where_the_hole_holds_the_root(
    circle: str, fillet: float, stands: bool
) -> None:
    if stands:
        solid = build_solid(pierced(circle, "12.0", fillet).part("shaft"))
        # by hand: the pierced flange, the segment, and the fillet's ring by Pappus, 0.223 of its radius off
        ring = (1 - pi / 4) * fillet**2 * 2 * pi * (9 / 2 + 0.223 * fillet)
        whole = pi / 4 * (4 * (20**2 - 12**2) + 24 * 9**2) + ring
        assert solid.Volume() == pytest.approx(whole, abs=0.01)
    else:
        with pytest.raises(DesignError, match="cut off"):
            pierced(circle, "12.0", fillet)


@pytest.mark.parametrize("second", [20.0, 24.0])
def test_a_segment_as_wide_as_the_flange_stands_on_its_rim(second: float) -> None:
    solid = build_solid(pierced("0.5", "19.0", second=second).part("shaft"))
    # by hand: a thin ring is left of the flange
    assert solid.Volume() == pytest.approx(pi / 4 * (4 * (20**2 - 19**2) + 24 * second**2))
