"""A solid mesh as a scikit-fem space: quadratic, with its patches as named boundaries.

`TetMesh` numbers middle nodes as its maker did (an unfolded sector copy by copy, a test's brick by bricks),
scikit-fem by its own edges. Only this module converts one into the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from skfem import ElementTetP2, FacetBasis, MappingAffine
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from flexspline.fea.solid.elements import determinants, quadratic_mesh, tet_rule
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
        curved = quadratic_mesh(mesh.nodes, mesh.cells)
        facets = _facet_numbers(curved, mesh)
        named = {p: facets[mesh.facet_patch == i] for i, p in enumerate(mesh.patches) if p}
        curved = curved.with_boundaries({p: mine for p, mine in named.items() if len(mine)})
        node = np.empty(len(mesh.nodes), int)
        node[curved.dofs.element_dofs.T] = mesh.cells
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


def _facet_numbers(curved: Any, mesh: TetMesh) -> np.ndarray:
    """scikit-fem's number (k,) of each facet; its own are in rising order of their corners."""
    n = int(mesh.cells[:, :4].max()) + 1
    theirs, ours = (
        (corners[0] * n + corners[1]) * n + corners[2]
        for corners in (
            curved.facets.astype(np.int64),
            np.sort(mesh.facets[:, :3], axis=1).T.astype(np.int64),
        )
    )
    return np.searchsorted(theirs, ours)
