"""Quadratic (P2) fields of scikit-fem on a meridian mesh, with named boundaries, and direct solves.

Unknowns are numbered as scikit-fem does: the mesh's vertices first, then the middles of its edges.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from skfem import Basis, ElementTriP2, MeshTri, MeshTri2

from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh, MeshingError, edge_middles
from flexspline.fea.edges import SIDES, distinct_edges, edge_numbers
from flexspline.fea.quadratic_triangle import shape_functions


@dataclass(frozen=True)
class Space:
    """A P2 basis, and the numbers on the outline.

    Attributes
    ----------
    basis : scikit-fem's, at its quadrature points; its mesh's boundaries have names.
    rim : (k, 3) numbers on each boundary edge of the meridian mesh: start, end, middle.
    numbers : sorted numbers on each named boundary, its ends included.
    """

    basis: Any
    rim: np.ndarray
    numbers: Mapping[str, np.ndarray]

    @property
    def count(self) -> int:
        """Number of P2 numbers."""
        return int(self.basis.N)

    @cached_property
    def dofs(self) -> np.ndarray:
        """Numbers (m, 6) of each triangle's corners, rising, and of the middles of 01, 12, 02."""
        return np.ascontiguousarray(self.basis.element_dofs.T)

    @cached_property
    def places(self) -> np.ndarray:
        """Points (count, 2) of the numbers, (r, z) [mm]."""
        return np.ascontiguousarray(self.basis.doflocs.T)

    @property
    def weights(self) -> np.ndarray:
        """Quadrature weights (m, q) times area [mm²]."""
        return self.basis.dx

    @property
    def r(self) -> np.ndarray:
        """Radius of the quadrature points (m, q) [mm]."""
        return np.asarray(self.basis.global_coordinates())[0]

    def on(self, boundary: str) -> np.ndarray:
        """Return the sorted numbers on a named boundary, its ends included; none where it does not exist."""
        return self.numbers.get(boundary, np.empty(0, int))

    def values(self, field: np.ndarray) -> np.ndarray:
        """Return a field (count,) at the quadrature points (m, q), without its gradient."""
        return field[self.dofs] @ self._shape_functions

    @cached_property
    def _shape_functions(self) -> np.ndarray:
        """At the quadrature points (6, q)."""
        return shape_functions(self.basis.X)


def curved(mesh: MeridianMesh, degree: int) -> Space:
    """Return P2 with fillets followed by curved edges: edge middles on the arc, geometry as the fields.

    Patches are boundaries by their names; `degree` is the quadrature's.

    Raises
    ------
    MeshingError
        If a curved edge folds its triangle.
    """
    edges, facets = _edges(mesh)
    middles = mesh.points[edges].mean(axis=1)
    middles[facets] = edge_middles(mesh.outline, mesh.points, mesh.edges, mesh.edge_segment)
    named = {p: mesh.segments_of(p) for p in {s.patch for s in mesh.outline.segments} if p}
    places = np.ascontiguousarray(np.vstack([mesh.points, middles]).T)
    quadratic = MeshTri2(places, _corners(mesh))
    quadratic = quadratic.with_boundaries(_named(named, mesh, facets))
    basis = Basis(quadratic, ElementTriP2(), intorder=degree, dofs=quadratic.dofs)
    jacobian = basis.mapping.detDF(basis.X)
    # corners stand in any sense, so either sign may come, but one per triangle
    folded = (jacobian * jacobian[:, :1] <= 0).any(axis=1)
    if folded.any():
        raise MeshingError(f"{int(folded.sum())} curved triangles fold over")
    return _space(basis, mesh, facets)


def straight(
    mesh: MeridianMesh, vertices: np.ndarray, degree: int, boundaries: Mapping[str, np.ndarray]
) -> Space:
    """Return P2 on the mesh's straight triangles, vertices at (n, 2), quadrature of a polynomial degree.

    `boundaries` gives the segments of the outline that each name stands for.
    """
    _, facets = _edges(mesh)
    linear = MeshTri(np.ascontiguousarray(vertices.T), _corners(mesh)).with_boundaries(
        _named(boundaries, mesh, facets)
    )
    return _space(Basis(linear, ElementTriP2(), intorder=degree), mesh, facets)


def moved(space: Space, vertices: np.ndarray, degree: int) -> Space:
    """Return a `straight` space with its vertices elsewhere (n, 2); numbers and boundaries stay."""
    old = space.basis
    mesh = MeshTri(np.ascontiguousarray(vertices.T), old.mesh.t)
    basis = Basis(mesh, old.elem, intorder=degree, dofs=old.dofs)
    return Space(basis, space.rim, space.numbers)


def _corners(mesh: MeridianMesh) -> np.ndarray:
    """The triangles' corners (3, m), rising."""
    return np.ascontiguousarray(np.sort(mesh.triangles, axis=1).T)


def _edges(mesh: MeridianMesh) -> tuple[np.ndarray, np.ndarray]:
    """The edges (e, 2) in scikit-fem's order, and the number (k,) of each of the meridian's boundary."""
    n = len(mesh.points)
    edges = distinct_edges(mesh.triangles[:, SIDES], n)
    return edges, np.searchsorted(edge_numbers(edges, n), edge_numbers(mesh.edges, n))


def _named(
    segments: Mapping[str, np.ndarray], mesh: MeridianMesh, facets: np.ndarray
) -> dict[str, np.ndarray]:
    return {name: facets[np.isin(mesh.edge_segment, mine)] for name, mine in segments.items()}


def _space(basis: Any, mesh: MeridianMesh, facets: np.ndarray) -> Space:
    rim = np.column_stack([mesh.edges, basis.facet_dofs[0, facets]])
    numbers = {name: basis.get_dofs(name).flatten() for name in basis.mesh.boundaries}
    return Space(basis, rim, numbers)


def at_points(space: Space, at: np.ndarray) -> Any:
    """Return the basis at other points (2, q) of each reference triangle, to evaluate fields there."""
    basis = space.basis
    weights = np.full(at.shape[1], 0.5 / at.shape[1])
    return Basis(
        basis.mesh, basis.elem, mapping=basis.mapping, quadrature=(at, weights), dofs=basis.dofs,
        disable_doflocs=True,
    )  # fmt: skip
