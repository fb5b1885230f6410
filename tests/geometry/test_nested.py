"""The cut body lies inside the part with holes, and that inside the whole body; so do their patches."""

from __future__ import annotations

import numpy as np
import pytest
from example_files import EXAMPLES
from holed_designs import holed_designs
from matplotlib.path import Path as Outline

from flexspline.geometry.check_flexspline import flexspline_faults
from flexspline.geometry.load import load_design
from flexspline.geometry.nested import nested_bodies
from flexspline.geometry.outline import Segment
from flexspline.geometry.part import Part

DESIGNS = 200
POINTS = 2000
"""Drawn in the meridian's box; of the thinnest parts a few lie in the body."""
ALONG = 20
"""Drawn on each segment of the outline, which the holes touch."""
CHORD = 1e-3
"""[mm] Both bodies' arcs are the same arcs, so their chords are the same chords."""
ROUNDING = 1e-9
"""[mm] Of circle ± hole."""


def patch(part: Part, name: str) -> list[Segment]:
    return [s for s in part.meridian.segments if s.patch == name]


def in_a_hole(part: Part, xyz: np.ndarray) -> np.ndarray:
    """Which points (n, 3) lie inside one of the holes."""
    bolts = part.bolts
    assert bolts is not None
    away = np.linalg.norm(xyz[:, None, :2] - np.array(bolts.centres), axis=2).min(axis=1)
    return (away < bolts.hole_radius - ROUNDING) & (xyz[:, 2] < part.hole_depth)


def test_on_random_parts() -> None:
    rng = np.random.default_rng(20261122)
    for design in holed_designs(DESIGNS):
        part = design.part("flexspline")
        bodies = nested_bodies(part)
        cut, whole = (Outline(b.meridian.polygon(CHORD)) for b in (bodies.cut, bodies.whole))
        assert not list(flexspline_faults(bodies.cut.shape)), design.name
        size = bodies.whole.meridian.polygon(CHORD).max(axis=0)
        rz = rng.uniform(0, 1, (POINTS, 2)) * size
        rz = rz[cut.contains_points(rz)]
        assert len(rz)
        assert whole.contains_points(rz).all(), design.name
        on_it = [s.at(rng.uniform(0, 1, ALONG)) for s in bodies.cut.meridian.segments]
        rz = np.concatenate([rz, *on_it])
        phi = rng.uniform(0, 2 * np.pi, len(rz))
        xyz = np.column_stack([rz[:, 0] * np.cos(phi), rz[:, 0] * np.sin(phi), rz[:, 1]])
        assert not in_a_hole(part, xyz).any(), design.name


def test_what_is_held_what_is_turned_and_the_seat() -> None:
    for design in holed_designs(DESIGNS):
        bodies = nested_bodies(design.part("flexspline"))
        for same in ("mesh", "seat"):
            assert patch(bodies.cut, same) == patch(bodies.whole, same)
        [held], [all_held] = patch(bodies.cut, "mount"), patch(bodies.whole, "mount")
        assert held.start[1] == held.end[1] == all_held.start[1] == 0
        assert all_held.start[0] < held.end[0] <= all_held.end[0]
        assert all_held.start[0] <= held.start[0] < all_held.end[0]
        # nothing of the cut body's own part of the mounted face is set free
        assert held.start == all_held.start or held.end == all_held.end


@pytest.mark.parametrize("file", ["xb1-40.toml", "hat-25.toml"])
def test_the_cut_touches_the_holes(file: str) -> None:
    """No more than their annulus and what lies beyond is cut: its wall is tangent to every hole."""
    part = load_design(EXAMPLES / file).part("flexspline")
    bolts, cut = part.bolts, nested_bodies(part).cut
    assert bolts is not None
    [held] = patch(cut, "mount")
    free = held.start[0] if part.shape.kind == "cup" else held.end[0]
    assert abs(free - bolts.radius) == pytest.approx(bolts.hole_radius, abs=ROUNDING)
    assert cut.bolts is None
    assert nested_bodies(part).whole.bolts is None


def test_a_part_without_holes_has_none() -> None:
    shaft = load_design(EXAMPLES / "xb1-40.toml").part("shaft")
    with pytest.raises(ValueError, match="bolt holes"):
        nested_bodies(shaft)
