"""Quadratic tetrahedra as scikit-fem has them, with their patches as named boundaries.

`TetMesh` numbers middle nodes as its maker did (an unfolded sector copy by copy, a test's brick by bricks),
scikit-fem by the rising corners of its edges. Only this module converts one into the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from skfem import MeshTet2

from flexspline.fea.edges import CORNER_FACES, TET_EDGES, face_numbers, numbered_edges
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
        every = np.unique(
            face_numbers(corners[:, CORNER_FACES], n)
        )  # scikit-fem's facets, in its order
        facets = np.searchsorted(every, face_numbers(mesh.facets[:, :3], n))
        named = {p: facets[mesh.facet_patch == i] for i, p in enumerate(mesh.patches) if p}
        doflocs, t = map(np.ascontiguousarray, (mesh.nodes[node].T, corners.T))
        curved = MeshTet2(doflocs, t, sort_t=False)
        return cls(curved.with_boundaries({p: f for p, f in named.items() if len(f)}), node)
