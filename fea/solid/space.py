"""A solid mesh as a scikit-fem space: quadratic fields, and the nodes, areas and values on its patches."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from skfem import ElementTetP2, FacetBasis, MappingAffine
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from flexspline.fea.solid.elements import determinants, tet_rule
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
        return cls(mesh.curved.mesh, mesh.cells, mesh.curved.node)

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
