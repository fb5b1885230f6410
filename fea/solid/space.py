"""A solid mesh as a scikit-fem space: quadratic, with its patches as named boundaries.

`TetMesh` numbers middle nodes as its maker did (an unfolded sector copy by copy, a test's brick by bricks),
scikit-fem by rising corners of its edges. Only this module converts one into the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from skfem import ElementTetP2, FacetBasis, MappingAffine, MeshTet2
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from flexspline.fea.edges import TET_EDGES, numbered_edges
from flexspline.fea.solid.elements import determinants, tet_rule
from flexspline.fea.solid.quadratic import CORNER_FACES
from flexspline.fea.types import TetMesh


@dataclass(frozen=True)
class SolidSpace:
    """P2 fields on a sector.

    Attributes
    ----------
    curved : scikit-fem's MeshTet2; patches that have facets are its boundaries.
    cells : (m, 10) the mesh's. node : (n,) the mesh's node of each of scikit-fem's numbers.
    """

    curved: Any
    cells: np.ndarray
    node: np.ndarray

    @classmethod
    def of(cls, mesh: TetMesh) -> SolidSpace:
        corners = mesh.cells[:, :4]
        n = int(corners.max()) + 1
        edges, of_cells = numbered_edges(corners[:, TET_EDGES], n)
        node = np.arange(n + len(edges))
        node[n + of_cells] = mesh.cells[:, 4:]
        facets = _facet_numbers(corners, mesh.facets[:, :3])
        named = {p: facets[mesh.facet_patch == i] for i, p in enumerate(mesh.patches) if p}
        curved = MeshTet2(np.ascontiguousarray(mesh.nodes[node].T), np.ascontiguousarray(corners.T), sort_t=False)
        curved = curved.with_boundaries({p: mine for p, mine in named.items() if len(mine)})
        return cls(curved, mesh.cells, node)

    def on(self, patch: str) -> np.ndarray:
        """Return the sorted nodes on a patch, its edges included; none where there is no such patch."""
        boundaries = self.curved.boundaries or {}
        if patch not in boundaries:
            return np.empty(0, int)
        return np.sort(self.node[self.curved.dofs.get_facet_dofs(boundaries[patch]).flatten()])

    @property
    def volumes(self) -> np.ndarray:
        """Volumes of the curved elements (m,) [mm³]."""
        points, weights = tet_rule()
        curved = self.curved
        return determinants(curved.doflocs.T, curved.dofs.element_dofs.T, points) @ weights

    def areas(self, patch: str) -> np.ndarray:
        """Return the areas of a patch's curved facets (k,) [mm²]; empty if the part has no such patch."""
        points, weights = get_quadrature(RefTri, 4)
        facets = (self.curved.boundaries or {}).get(patch, np.empty(0, int))
        return np.asarray(self.curved.mapping().detDG(points, find=facets) @ weights)

    def facet_basis(self, patch: str, degree: int) -> Any:
        """Return scikit-fem's basis on a patch's curved facets, for the fields' values, not their slopes.

        The values at a facet's points are those on the flat facet. There its place in the element is a matter
        of corners; scikit-fem's search for it in the curved one does not end on coarse meshes.
        """
        basis = FacetBasis(
            self.curved, ElementTetP2(), mapping=MappingAffine(self.curved), facets=patch,
            intorder=degree, dofs=self.curved.dofs, disable_doflocs=True,
        )  # fmt: skip
        basis.mapping = self.curved.mapping()
        basis.dx = basis.mapping.detDG(basis.X, find=basis.find) * basis.W
        return basis


def _facet_numbers(tets: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """scikit-fem's number (k,) of each facet of corners (k, 3), in rising order of their corners."""
    n = int(tets.max()) + 1

    def numbers(corners: np.ndarray) -> np.ndarray:
        first, second, third = np.sort(corners, axis=-1).astype(np.int64).T
        return (first * n + second) * n + third

    return np.searchsorted(np.unique(numbers(tets[:, CORNER_FACES])), numbers(facets))
