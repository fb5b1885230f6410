"""A shaft lies between the two without fillets that stand for it; all else is where it was."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count, islice

import numpy as np
import pytest
from matplotlib.path import Path as Outline
from random_designs import design_of
from shaft_of import shaft_of

from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import design_from
from flexspline.geometry.nested import has_unfilleted_bodies, unfilleted_bodies
from flexspline.geometry.part import Part

SHAFTS = 80
POINTS = 4000
"""Drawn in the box of the larger body's meridian."""
NEAR_CORNERS = 400
"""Drawn within a fillet's radius of each step."""
CHORD = 1e-4
"""[mm] Arcs are concave: their chords lie in the material, by this much less than fillets are wide."""
ROUNDING = 1e-9
"""[mm]"""


def shafts() -> Iterator[Part]:
    """Random shafts that have the two bodies, fillets of all sizes."""
    for number in count(30_000):
        try:
            part = design_from(design_of(number, slips=False)).part("shaft")
        except DesignError:
            continue
        if has_unfilleted_bodies(part):
            yield part


def drawn(part: Part, whole: Part, rng: np.random.Generator) -> np.ndarray:
    """Points (n, 2), (r, z) [mm], many of them where the bodies differ."""
    size = whole.meridian.polygon(CHORD).max(axis=0)
    found = [rng.uniform(0, 1, (POINTS, 2)) * size]
    z, fillet = 0.0, part.shape.fillet_mm  # type: ignore[union-attr]
    for segment in part.shape.segment:  # type: ignore[union-attr]
        r = segment.outer_diameter_mm / 2
        for end in (z, z + segment.length_mm):
            found.append((r, end) + rng.uniform(-1, 1, (NEAR_CORNERS, 2)) * fillet)
        z += segment.length_mm
    return np.vstack(found)


def in_material(part: Part, rz: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Which points are in the part, its holes and keyway left out."""
    inside = Outline(part.meridian.polygon(CHORD)).contains_points(rz)
    x, y = rz[:, 0] * np.cos(phi), rz[:, 0] * np.sin(phi)
    if part.bolts is not None:
        away = np.linalg.norm(np.stack([x, y], axis=1)[:, None] - part.bolts.centres, axis=2)
        inside &= (away.min(axis=1) > part.bolts.hole_radius) | (rz[:, 1] > part.hole_depth)
    if part.keyway is not None:
        slot = part.keyway
        cut = (x > slot.floor) & (np.abs(y) < slot.half_width) & (rz[:, 1] > slot.start)
        inside &= ~cut
    return inside


def test_on_random_shafts() -> None:
    rng = np.random.default_rng(20261127)
    differ = holed = keyed = 0
    for part in islice(shafts(), SHAFTS):
        bodies = unfilleted_bodies(part)
        rz = drawn(part, bodies.whole, rng)
        phi = rng.uniform(0, 2 * np.pi, len(rz))
        cut, own, whole = (in_material(b, rz, phi) for b in (bodies.cut, part, bodies.whole))
        # the bore may lie on the sampled line, and chords of arcs in the material: nothing else may differ
        assert not (cut & ~own).any(), part.shape
        assert not (own & ~whole).any(), part.shape
        differ += (own & ~cut).any() and (whole & ~own).any()
        holed += part.bolts is not None
        keyed += part.keyway is not None
    assert differ > SHAFTS / 2  # the points reach the fillets
    assert min(holed, keyed) > SHAFTS / 10


def test_patches_are_where_they_were() -> None:
    for part in islice(shafts(), SHAFTS):
        bodies = unfilleted_bodies(part)
        for patch in ("mount", "grip"):
            ends = [
                sorted((*s.start, *s.end))
                for body in (bodies.cut, part, bodies.whole)
                for s in body.meridian.segments
                if s.patch == patch
            ]
            assert np.ptp(ends, axis=0).max() < ROUNDING, (patch, part.shape)


@pytest.mark.parametrize(
    ("settings", "has"),
    [
        ("", True),
        ("fillet_mm = 0", False),
        ("grip_length_mm = 10.2", False),  # it holds the step too
        ("grip_length_mm = 9.4", True),
    ],
)
def test_which_shafts_have_them(settings: str, has: bool) -> None:
    segments = [(4.0, 20.0, 6.0), (10.0, 16.0, 6.0)]
    assert has_unfilleted_bodies(shaft_of(segments, settings).part("shaft")) == has


def test_holes_under_a_step_keep_their_depth() -> None:
    """Holes that cut into the thinner segment's circle end where they did; others may go through the step."""
    for circle, depth in ((14.0, 4.5), (10.0, 4.0)):
        holes = f"bolt_count = 4\nbolt_circle_diameter_mm = {circle}\nbolt_hole_diameter_mm = 2"
        part = shaft_of([(4.0, 20.0, 6.0), (12.0, 10.0, 6.0)], holes).part("shaft")
        assert unfilleted_bodies(part).whole.hole_depth == depth


@pytest.mark.parametrize("second", [2.0, 2.5])
def test_a_groove_as_wide_as_its_fillets(second: float) -> None:
    """Filled by them altogether: the holes of the flange are not let through what is beyond it."""
    holes = "bolt_count = 4\nbolt_circle_diameter_mm = 16.5\nbolt_hole_diameter_mm = 2"
    part = shaft_of(
        [(4.0, 20.0, 6.0), (second, 12.0, 6.0), (14.0, 20.0, 6.0)], holes, fillet=1.0
    ).part("shaft")
    bodies = unfilleted_bodies(part)
    assert bodies.whole.hole_depth == 5.0  # the flange and its moved step
    rng = np.random.default_rng(3)
    rz = rng.uniform(0, 1, (POINTS, 2)) * (10.0, part.length)
    phi = rng.uniform(0, 2 * np.pi, len(rz))
    assert not (in_material(part, rz, phi) & ~in_material(bodies.whole, rz, phi)).any()
