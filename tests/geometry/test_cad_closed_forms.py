"""CAD volumes and patch areas of the examples against closed forms, STEP and STL round trips.

Nothing here comes from `geometry.profile`: cylinders, Pappus' fillet, numeric integration.
"""

from __future__ import annotations

from itertools import pairwise
from math import asin, pi, sqrt
from pathlib import Path

import numpy as np
import pytest
from example_files import EXAMPLES
from scipy.integrate import dblquad
from shaft_of import shaft_of

from flexspline.geometry.cad import build_solid, write_step, write_stl
from flexspline.geometry.load import load_design
from flexspline.geometry.tagged import tagged_surface

KERNEL = 1e-7
"""Relative: the kernel integrates volumes and areas to about 1e-8."""


def tube(outer: float, inner: float, length: float) -> float:
    return pi * (outer**2 - inner**2) * length


def fillet_volume(edge: float, radius: float, sign: int) -> float:
    """Of the ring between a 90° corner at r = edge and the arc that rounds it, away from the axis
    (sign −1: the corner's material lies inwards of the edge) or towards it (sign +1).

    Pappus: area (1 − π/4)f², centroid f(10 − 3π)/(12 − 3π) from each side of the corner.
    """
    area = (1 - pi / 4) * radius**2
    centroid = radius * (10 - 3 * pi) / (12 - 3 * pi)
    return 2 * pi * (edge + sign * centroid) * area


def test_cup_volume() -> None:
    # xb1-40: tube, ring with its 45° shoulder, diaphragm, boss, two fillets, six holes
    ri, rw, rr = 19.2, 19.6, 19.75
    shoulder = pi * 0.15 / 3 * (rw**2 + rw * rr + rr**2) - pi * rw**2 * 0.15
    expected = (
        tube(rw, ri, 30 - 0.6)
        + tube(rr, rw, 8)
        + shoulder
        + tube(rw, 4, 0.6)
        + tube(9, 4, 3 - 0.6)
        + fillet_volume(ri, 1.0, -1)  # fills the inside corner
        - fillet_volume(rw, 1.0, -1)  # takes the outside corner
        - 6 * pi / 4 * 2.5**2 * 3
    )
    solid = build_solid(load_design(EXAMPLES / "xb1-40.toml").part("flexspline"))
    assert solid.Volume() == pytest.approx(expected, rel=KERNEL)


def test_hat_volume() -> None:
    ri, rw, rr = 28.8, 29.3, 29.625
    shoulder = pi * 0.325 / 3 * (rw**2 + rw * rr + rr**2) - pi * rw**2 * 0.325
    expected = (
        tube(rw, ri, 28)
        + tube(rr, rw, 11)
        + shoulder
        + tube(39, rw, 0.5)
        + tube(48, 39, 4)
        + fillet_volume(rw, 1.5, +1)
        - fillet_volume(ri, 1.5, +1)
        - 12 * pi / 4 * 3.4**2 * 4
    )
    solid = build_solid(load_design(EXAMPLES / "hat-25.toml").part("flexspline"))
    assert solid.Volume() == pytest.approx(expected, rel=KERNEL)


@pytest.mark.parametrize("length", [16.0, 20.0, 27.0])
def test_keyway_volume(length: float) -> None:
    """The slot x > 5, |y| < 2.5 of the keyed shaft, also on through the fillet into segment[1]."""

    def outside(z: float) -> float:
        if z > 16.5:
            return 8.0
        return 8.5 - sqrt(0.25 - (16.5 - z) ** 2) if z > 16 else 9.0

    def slot(z_from: float, z_to: float) -> float:
        found, _ = dblquad(
            lambda y, z: sqrt(outside(z) ** 2 - y**2) - 5.0, z_from, z_to, -2.5, 2.5, epsrel=1e-10
        )
        return found

    start = 36.0 - length
    pieces = [max(start, z) for z in (start, 16.0, 16.5)] + [36.0]
    expected = sum(slot(a, b) for a, b in pairwise(pieces) if b > a)
    plain = shaft_of([(4.0, 20.0, 6.0), (12.0, 18.0, 6.0), (20.0, 16.0, 6.0)])
    keyed = load_design(EXAMPLES / "keyed-shaft.toml").changed({"shaft.keyway.length_mm": length})
    cut = build_solid(plain.part("shaft")).Volume() - build_solid(keyed.part("shaft")).Volume()
    # 1e-5 of the slot: two volumes twenty times its size, each to KERNEL, are subtracted
    assert cut == pytest.approx(expected, rel=1e-5)


def test_patch_areas() -> None:
    cup = load_design(EXAMPLES / "xb1-40.toml")
    areas = tagged_surface(cup.part("flexspline"), 360.0, 0.02, 1.0).patch_areas
    assert areas["mount"] == pytest.approx(pi * (81 - 16) - 6 * pi / 4 * 2.5**2, rel=KERNEL)
    assert areas["mesh"] == pytest.approx(2 * pi * 19.75 * 8, rel=KERNEL)
    assert areas["seat"] == pytest.approx(2 * pi * 19.2 * 8, rel=KERNEL)
    hat = load_design(EXAMPLES / "hat-25.toml")
    areas = tagged_surface(hat.part("flexspline"), 360.0, 0.02, 1.0).patch_areas
    assert areas["mount"] == pytest.approx(pi * (48**2 - 39**2) - 12 * pi / 4 * 3.4**2, rel=KERNEL)
    assert areas["mesh"] == pytest.approx(2 * pi * 29.625 * 11, rel=KERNEL)
    assert areas["seat"] == pytest.approx(2 * pi * 28.8 * 11, rel=KERNEL)
    shaft = load_design(EXAMPLES / "keyed-shaft.toml")
    areas = tagged_surface(shaft.part("shaft"), 360.0, 0.02, 1.0).patch_areas
    mouth = 2 * asin(2.5 / 8) * 8 * 16  # the key's mouth lies wholly within the grip of 18
    assert areas["grip"] == pytest.approx(2 * pi * 8 * 18 - mouth, rel=KERNEL)
    assert areas["mount"] == pytest.approx(pi * (100 - 9), rel=KERNEL)


def test_grip_of_a_solid_shaft_leaves_its_end_face_out() -> None:
    solid = shaft_of([(4.0, 20.0, 0.0), (20.0, 16.0, 0.0)])
    areas = tagged_surface(solid.part("shaft"), 360.0, 0.02, 1.0).patch_areas
    assert areas["grip"] == pytest.approx(2 * pi * 8 * 5, rel=KERNEL)


def test_grip_over_three_segments_leaves_faces_and_fillets_out() -> None:
    steps = [(4.0, 20.0, 6.0), (5.0, 17.0, 4.0), (6.0, 21.0, 15.0), (7.0, 18.0, 0.0)]
    areas = tagged_surface(
        shaft_of(steps, "grip_length_mm = 15.0").part("shaft"), 360.0, 0.02, 1.0
    ).patch_areas
    # from z = 7: of 17 up to the fillet below 21, all of 21, of 18 from its fillet on
    expected = pi * (17 * 1.5 + 21 * 6 + 18 * 6.5)
    assert areas["grip"] == pytest.approx(expected, rel=KERNEL)


@pytest.mark.cad
@pytest.mark.parametrize(
    ("example", "part", "length"),
    [
        ("xb1-40", "flexspline", 30.0),
        ("hat-25", "flexspline", 28.0),
        ("keyed-shaft", "shaft", 36.0),
    ],
)
def test_step_and_stl_keep_the_volume(
    example: str, part: str, length: float, tmp_path: Path
) -> None:
    import cadquery as cq
    import trimesh

    solid = build_solid(load_design(EXAMPLES / f"{example}.toml").part(part))
    write_step(solid, tmp_path / "part.step", "a/b 'c', shaft")
    written = (tmp_path / "part.step").read_text(encoding="ascii")
    assert "PRODUCT('a/b ''c'', shaft'," in written
    again = cq.importers.importStep(str(tmp_path / "part.step")).val()
    # STEP writes 15 digits, the surfaces are the same
    assert again.Volume() == pytest.approx(solid.Volume(), rel=KERNEL)
    chord = 0.005
    write_stl(solid, tmp_path / "part.stl", chord)
    mesh = trimesh.load_mesh(tmp_path / "part.stl")
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    # no triangle is farther than the chord error from the surface
    assert abs(mesh.volume - solid.Volume()) < chord * mesh.area
    assert np.ptp(mesh.vertices[:, 2]) == pytest.approx(length, rel=1e-6)  # STL: floats of 32 bits
