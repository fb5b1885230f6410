"""Patch edges put into meshes that do not have them: exact, closed, nothing turned inside out."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from skfem import MeshTet
from structured import from_cylindrical

from flexspline.fea.solid.imprint import MesherMesh, smooth_patch_edges, with_patch_edges
from flexspline.fea.solid.quadratic import boundary_faces
from flexspline.fea.solid.tetwild import signed_volumes
from flexspline.fea.solid.unroll import Cartesian, MeshingMap, Unrolled
from flexspline.geometry.outline import Segment
from flexspline.geometry.surfaces import Surface, Swept, sector_planes

INNER, EDGE, OUTER, HEIGHT = 2.0, 4.0, 6.0, 1.5
SECTOR = pi / 3
RING: list[Surface] = [
    Swept(Segment((INNER, 0), (EDGE, 0), patch="mount")),
    Swept(Segment((EDGE, 0), (OUTER, 0))),
    Swept(Segment((OUTER, 0), (OUTER, HEIGHT), patch="grip")),
    Swept(Segment((OUTER, HEIGHT), (INNER, HEIGHT))),
    Swept(Segment((INNER, HEIGHT), (INNER, 0))),
    *sector_planes(60.0),
]
"""A flat ring whose lower side is `mount` up to a circle in the middle of the plane."""


def cylindrical(points: np.ndarray) -> np.ndarray:
    """(x, y, z) to (r, φ, z)."""
    r, phi = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])
    return np.column_stack([r, phi, points[:, 2]])


def loose_mesh(seed: int, space: MeshingMap) -> tuple[np.ndarray, np.ndarray]:
    """The ring's sector in tetrahedra (in meshing space) that know nothing of its circle."""
    lines = np.linspace(INNER, OUTER, 8), np.linspace(0, SECTOR, 7), np.linspace(0, HEIGHT, 4)
    box = MeshTet.init_tensor(*lines)
    corners, tets = box.p.T.copy(), box.t.T.astype(np.int64)
    inside = (corners > corners.min(axis=0)) & (corners < corners.max(axis=0))
    steps = np.array([line[1] for line in lines]) - [line[0] for line in lines]
    shaken = np.random.default_rng(seed).uniform(-0.25, 0.25, corners.shape) * steps
    points = space.to(from_cylindrical(corners + np.where(inside, shaken, 0.0)))
    back = signed_volumes(points, tets) < 0
    tets[back] = tets[back][:, [0, 2, 1, 3]]
    return points, tets


def lower_side(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Mask of facets in the plane z = 0."""
    return (np.abs(points[faces][:, :, 2]) < 1e-12).all(axis=1)


@pytest.mark.parametrize("space", [Cartesian(), Unrolled(3.0, 60.0)], ids=["part", "unrolled"])
@pytest.mark.parametrize("seed", range(6))
def test_the_circle_is_in_the_mesh(seed: int, space: MeshingMap) -> None:
    points, tets = loose_mesh(seed, space)
    faces = boundary_faces(tets)
    down = lower_side(points, faces)
    centre = cylindrical(space.back(points[faces].mean(axis=1)))[:, 0]
    facet_surface = np.where(down, np.where(centre < EDGE, 0, 1), 2)
    before = signed_volumes(points, tets).sum()

    made = with_patch_edges(MesherMesh(points, tets, faces, facet_surface), RING, space)
    new, more = made.points, made.tets

    assert len(more) > len(tets)  # some edges cross in their middle
    assert signed_volumes(new, more).min() > 0
    assert signed_volumes(new, more).sum() == pytest.approx(before, rel=1e-12)
    outside = made.faces
    assert {tuple(f) for f in np.sort(outside).tolist()} == {
        tuple(f) for f in np.sort(boundary_faces(more)).tolist()
    }
    sides = np.vstack([outside[:, [0, 1]], outside[:, [1, 2]], outside[:, [2, 0]]])
    there = {tuple(s) for s in sides.tolist()}
    assert {(b, a) for a, b in there} == there  # every split is the neighbours' too

    plane = outside[lower_side(new, outside)]
    r, phi, _ = cylindrical(space.back(new)).T
    beyond = r[plane] - EDGE
    assert not ((beyond.min(axis=1) < -1e-9) & (beyond.max(axis=1) > 1e-9)).any()
    rim = np.sort(phi[np.unique(plane[np.abs(beyond) < 1e-9])])
    assert rim[[0, -1]] == pytest.approx([0, SECTOR], abs=1e-12)
    mount = space.back(new)[outside[made.facet_surface == 0]]
    assert len(mount) == (beyond.max(axis=1) < 1e-9).sum()
    area = np.linalg.norm(np.cross(mount[:, 1] - mount[:, 0], mount[:, 2] - mount[:, 0]), axis=1)
    bore = np.sort(phi[np.unique(plane[r[plane] < INNER + 1e-9])])
    wanted = EDGE**2 * np.sin(np.diff(rim)).sum() - INNER**2 * np.sin(np.diff(bore)).sum()
    assert area.sum() == pytest.approx(wanted, rel=1e-9)  # between two polygons on the circles


def test_only_smooth_joints_of_two_patches_need_it() -> None:
    """Corners are the mesher's own, and a fillet's end on a plane is no patch edge."""
    found = list(smooth_patch_edges(RING))
    assert [(e.first, e.second) for e in found] == [(0, 1)]
    fillet = Swept(Segment((OUTER, 0), (OUTER + 1, 1), centre=(OUTER, 1)))
    assert [(e.first, e.second) for e in smooth_patch_edges([*RING[:2], fillet])] == [(0, 1)]


def test_a_mesh_that_has_the_circle_stays_as_it_is() -> None:
    points, tets = loose_mesh(0, Cartesian())
    faces = boundary_faces(tets)
    surface = np.where(lower_side(points, faces), 0, 2)
    once = with_patch_edges(MesherMesh(points, tets, faces, surface), RING, Cartesian())
    again = with_patch_edges(once, RING, Cartesian())
    assert (again.points == once.points).all()
    assert (again.tets == once.tets).all()
    assert (again.facet_surface == once.facet_surface).all()


def test_an_edge_across_two_circles_is_halved_at_both() -> None:
    """A narrow patch within one triangle: what the first circle makes is met by the second."""
    points, tets = loose_mesh(1, Cartesian())
    faces = boundary_faces(tets)
    narrow = EDGE + 0.05
    surfaces: list[Surface] = [
        Swept(Segment((INNER, 0), (EDGE, 0), patch="mount")),
        Swept(Segment((EDGE, 0), (narrow, 0), patch="grip")),
        Swept(Segment((narrow, 0), (OUTER, 0))),
        *RING[2:],
    ]
    surface = np.where(lower_side(points, faces), 0, 3)
    made = with_patch_edges(MesherMesh(points, tets, faces, surface), surfaces, Cartesian())
    assert np.array_equal(np.unique(made.tets), np.arange(len(made.points)))
    assert signed_volumes(made.points, made.tets).min() > 0
    radius = np.hypot(*made.points[made.faces][:, :, :2].transpose(2, 0, 1))
    ranges = [(INNER, EDGE), (EDGE, narrow), (narrow, OUTER)]
    for mine, (low, high) in enumerate(ranges):
        there = radius[made.facet_surface == mine]
        assert there.min() == pytest.approx(low, abs=1e-9)
        assert there.max() == pytest.approx(high, abs=1e-9)
