"""Fields on a meridian mesh, seen at any of its points, and meshes that are fine in a box."""

from __future__ import annotations

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.axisymmetric.bisection import Box, refined_within
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh, MeshingError, edge_lengths
from flexspline.fea.axisymmetric.places import Places
from flexspline.fea.axisymmetric.space import straight
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.geometry.load import load_design

CUP = load_design(EXAMPLES / "xb1-40.toml").part("flexspline")
AT_HOLES = Box((5.25, 7.75), (0.0, 2.0), longest_mm=0.5)


@pytest.fixture(scope="module")
def mesh() -> MeridianMesh:
    return refined_within(triangulate(CUP.without_holes().meridian), [AT_HOLES])


def test_a_quadratic_field_is_seen_exactly_with_its_slopes(mesh: MeridianMesh) -> None:
    space = straight(mesh, mesh.points, 4, {})
    r, z = space.places.T
    field = 3 * r**2 - 2 * r * z + z**2 - r + 5
    share = np.random.default_rng(1).dirichlet((1, 1, 1), len(mesh.triangles))
    at = np.einsum("mc,mcd->dm", share, mesh.points[mesh.triangles])
    seen = Places.of(space, *at).see(field)
    r, z = at
    assert np.asarray(seen) == pytest.approx(3 * r**2 - 2 * r * z + z**2 - r + 5, rel=1e-9)
    assert seen.grad[0] == pytest.approx(6 * r - 2 * z - 1, rel=1e-7, abs=1e-7)
    assert seen.grad[1] == pytest.approx(2 * z - 2 * r, rel=1e-7, abs=1e-7)


def test_corners_and_middles_of_sides_have_a_triangle_too(mesh: MeridianMesh) -> None:
    space = straight(mesh, mesh.points, 4, {})
    seen = Places.of(space, *space.places.T).see(space.places[:, 0])
    assert np.asarray(seen) == pytest.approx(space.places[:, 0], abs=1e-9)


def test_a_point_outside_is_an_error(mesh: MeridianMesh) -> None:
    space = straight(mesh, mesh.points, 4, {})
    inside = mesh.points[mesh.triangles[0]].mean(axis=0)
    with pytest.raises(MeshingError, match="1 of 2 places"):
        Places.of(space, np.array([inside[0], 500.0]), np.array([inside[1], 0.0]))


def test_a_point_just_outside_is_seen_at_the_nearest_place(mesh: MeridianMesh) -> None:
    """A mesher's nodes are within 1e-6 mm of the surface they are on."""
    space = straight(mesh, mesh.points, 4, {})
    z = space.places[:, 1]
    on_mount = space.places[z == z.min()]
    seen = Places.of(space, on_mount[:, 0], on_mount[:, 1] - 1e-6).see(space.places[:, 0])
    assert np.asarray(seen) == pytest.approx(on_mount[:, 0], abs=1e-9)


def test_in_the_box_no_edge_is_longer_and_elsewhere_most_stay(mesh: MeridianMesh) -> None:
    first = triangulate(CUP.without_holes().meridian)
    lengths = edge_lengths(mesh.points, mesh.triangles).max(axis=1)
    met = AT_HOLES.meets(mesh)
    assert met.any()
    assert lengths[met].max() <= 0.5
    assert edge_lengths(first.points, first.triangles)[AT_HOLES.meets(first)].max() > 0.5
    far = mesh.points[mesh.triangles][..., 1].min(axis=1) > 10.0
    assert far.sum() <= (first.points[first.triangles][..., 1].min(axis=1) > 10.0).sum() + 20
