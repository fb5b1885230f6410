"""What counts as a corner: one limit for the meridian, the CAD solid and both meshers."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians, tan

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.solid.swept_sizing import critical_points
from flexspline.geometry.load import load_design
from flexspline.geometry.outline import Meridian, Segment, SMOOTH_rad, closed, joins_smoothly
from flexspline.geometry.part import Part
from flexspline.geometry.tagged import tagged_surface

FLATTEST_rad = pi / 4
"""The shoulder between wall and toothed ring, the flattest corner that a part has."""


@dataclass(frozen=True)
class Drawn(Part):
    """A part of another outline than its shape's."""

    outline: Meridian

    @property
    def meridian(self) -> Meridian:  # type: ignore[override]
        """As drawn."""
        return self.outline


def dented(turn_deg: float) -> Meridian:
    """A ring, 8 to 10 mm, 8 mm high, whose outside goes in at half height and turns there by an angle."""
    depth = 4 * tan(radians(turn_deg / 2))
    corners = [(8.0, 0.0), (10.0, 0.0), (10.0 - depth, 4.0), (10.0, 8.0), (8.0, 8.0)]
    return closed([(corner, None) for corner in corners])


@pytest.mark.parametrize(("turn_deg", "is_corner"), [(0.5, False), (1.0, False), (1.5, True)])
def test_a_slight_corner_is_one_everywhere_or_nowhere(turn_deg: float, is_corner: bool) -> None:
    outline = dented(turn_deg)
    dent = outline.segments[2].start
    assert (dent in outline.sharp_corners) == is_corner
    assert (dent in outline.inside_corners) == is_corner
    assert (dent in map(tuple, critical_points(outline))) == is_corner
    assert joins_smoothly(*outline.segments[1:3]) != is_corner
    shaft = load_design(EXAMPLES / "keyed-shaft.toml").part("shaft").without_holes()
    solid = tagged_surface(Drawn(shaft.shape, shaft.material, outline), 90.0, 0.01, 1.0)
    for edges in (solid.sharp_edges, solid.critical_edges):
        assert np.isclose(edges[:, 2], 4.0, rtol=0, atol=1e-6).any() == is_corner


def test_outside_corners_are_sharp_and_not_inside() -> None:
    outline = dented(10.0)
    assert set(outline.sharp_corners) == {s.start for s in outline.segments}
    assert outline.inside_corners == (outline.segments[2].start,)


def test_an_arc_tangent_to_a_line_joins_smoothly() -> None:
    line, arc = Segment((1.0, 0.0), (3.0, 0.0)), Segment((3.0, 0.0), (4.0, 1.0), centre=(3.0, 1.0))
    assert joins_smoothly(line, arc)
    assert not joins_smoothly(line, Segment((3.0, 0.1), (4.0, 0.1)))  # it begins elsewhere


@pytest.mark.parametrize("example", ["xb1-40", "hat-25", "keyed-shaft"])
def test_the_limit_is_far_from_every_joint_of_a_part(example: str) -> None:
    for part in load_design(EXAMPLES / f"{example}.toml").parts:
        turns = [abs(by) for _, by in part.meridian.turns]
        # fillets are tangent but for rounding
        assert all(by < 1e-6 * SMOOTH_rad or by > FLATTEST_rad - 1e-9 for by in turns)
