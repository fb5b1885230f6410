"""Edges and facets have scikit-fem's own numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from skfem import Mesh, MeshTet, MeshTri

from flexspline.fea.entities import Tetrahedra, Triangles


def shuffled(mesh: Any) -> tuple[np.ndarray, np.ndarray]:
    """Points and elements of a mesh, its corners numbered and turned at random."""
    rng = np.random.default_rng(0)
    place = rng.permutation(mesh.p.shape[1])
    t = rng.permuted(place[mesh.t], axis=0).astype(np.int32)
    points = np.empty_like(mesh.p)
    points[:, place] = mesh.p
    return points, t


@pytest.mark.parametrize("named", ["edges", "facets", "t2e", "t2f", "f2e", "f2t"])
def test_numbers_of_tetrahedra(named: str) -> None:
    points, t = shuffled(MeshTet().refined(2))
    own, theirs = (kind(points, t, sort_t=False) for kind in (Tetrahedra, MeshTet))
    assert np.array_equal(getattr(own, named), getattr(theirs, named))


@pytest.mark.parametrize("named", ["facets", "t2f", "f2t"])
def test_numbers_of_triangles(named: str) -> None:
    points, t = shuffled(MeshTri().refined(3))
    own, theirs = (kind(points, t, sort_t=False) for kind in (Triangles, MeshTri))
    assert np.array_equal(getattr(own, named), getattr(theirs, named))


def test_corner_numbers_too_large_for_one_integer() -> None:
    """A facet of three corners of up to 2³¹ would take 93 bits."""
    t = np.array([[0, 1], [1, 2], [2, 3], [2**31 - 1, 2**31 - 2]])
    sides = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
    for own, theirs in zip(
        Tetrahedra.build_entities(t, sides), Mesh.build_entities(t, sides), strict=True
    ):
        assert np.array_equal(own, theirs)


def test_a_copy_with_boundaries_is_the_same_kind() -> None:
    mesh = Tetrahedra(*shuffled(MeshTet().refined(1)), sort_t=False)
    assert isinstance(mesh.with_boundaries({"some": np.array([0])}), Tetrahedra)
