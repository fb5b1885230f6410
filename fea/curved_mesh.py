"""Quadratic tetrahedra as scikit-fem has them, with their patches as named boundaries.

`TetMesh` numbers middle nodes as its maker did (an unfolded sector copy by copy, a test's brick by bricks),
scikit-fem by the rising corners of its edges. Only this module converts one into the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from skfem import MeshTet2

from flexspline.fea.edges import CORNER_FACES, TET_EDGES, numbered_edges
from flexspline.fea.types import TetMesh


@dataclass(frozen=True)
class CurvedMesh:
    """scikit-fem's mesh and its numbers.

    Attributes
    ----------
    mesh : MeshTet2; patches that have facets are its boundaries.
    node : (n,) the `TetMesh`'s node of each of scikit-fem's numbers.
    """

    mesh: Any
    node: np.ndarray

    @classmethod
    def of(cls, mesh: TetMesh) -> CurvedMesh:
        corners = mesh.cells[:, :4]
        n = int(corners.max()) + 1
        edges, of_cells = numbered_edges(corners[:, TET_EDGES], n)
        node = np.arange(n + len(edges))
        node[n + of_cells] = mesh.cells[:, 4:]
        facets = _facet_numbers(corners, mesh.facets[:, :3])
        named = {p: facets[mesh.facet_patch == i] for i, p in enumerate(mesh.patches) if p}
        curved = MeshTet2(_by_rows(mesh.nodes[node]), _by_rows(corners), sort_t=False)
        return cls(curved.with_boundaries({p: f for p, f in named.items() if len(f)}), node)


def _by_rows(table: np.ndarray) -> np.ndarray:
    """(n, k) as scikit-fem takes it, (k, n)."""
    return np.ascontiguousarray(table.T)


def _facet_numbers(tets: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """scikit-fem's number (k,) of each facet of corners (k, 3), in rising order of their corners."""
    n = int(tets.max()) + 1

    def numbers(corners: np.ndarray) -> np.ndarray:
        first, second, third = np.sort(corners, axis=-1).astype(np.int64).T
        return (first * n + second) * n + third

    return np.searchsorted(np.unique(numbers(tets[:, CORNER_FACES])), numbers(facets))
