"""Edges stand in the order of scikit-fem, whose numbers of unknowns follow from it."""

from __future__ import annotations

from typing import Any

import numpy as np
from skfem import MeshTet, MeshTri

from flexspline.fea.edges import SIDES, TET_EDGES, numbered_edges


def shuffled(mesh: Any) -> np.ndarray:
    """The elements (m, k) of a mesh, its corners numbered and turned at random."""
    rng = np.random.default_rng(0)
    place = rng.permutation(mesh.p.shape[1])
    return rng.permuted(place[mesh.t], axis=0).astype(np.int32).T


def test_edges_of_tetrahedra() -> None:
    cells = shuffled(MeshTet().refined(2))
    theirs = MeshTet(np.zeros((3, cells.max() + 1)), cells.T, sort_t=False)
    edges, of = numbered_edges(cells[:, TET_EDGES], cells.max() + 1)
    assert np.array_equal(edges, theirs.edges.T)
    assert np.array_equal(of, theirs.t2e.T)


def test_edges_of_triangles() -> None:
    cells = shuffled(MeshTri().refined(3))
    theirs = MeshTri(np.zeros((2, cells.max() + 1)), cells.T, sort_t=False)
    edges, of = numbered_edges(cells[:, SIDES], cells.max() + 1)
    assert np.array_equal(edges, theirs.facets.T)
    assert np.array_equal(of, theirs.t2f.T)
