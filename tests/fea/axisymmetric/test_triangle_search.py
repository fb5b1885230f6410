"""The triangle that holds a point."""

from __future__ import annotations

import numpy as np
from skfem import MeshTri

from flexspline.fea.axisymmetric.triangle_search import triangles_of


def test_a_point_is_found_in_the_triangle_that_scikit_fem_finds() -> None:
    """And in none where scikit-fem raises an error: the L has no corner at (1, 1)."""
    mesh = MeshTri.init_lshaped().refined(3)
    points = np.random.default_rng(3).uniform(-1, 1, (2, 300))
    inside = ~(points > 0).all(axis=0)
    found = triangles_of(mesh, points)
    assert np.array_equal(found[inside], mesh.element_finder()(*points[:, inside]))
    assert (found[~inside] == -1).all()
    assert (~inside).any()
