"""Quadratic (P2) fields on a meridian mesh: numbering, gradients, sparse sums, solve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from fea.axisymmetric.meridian_mesh import MeridianMesh


@dataclass(frozen=True)
class Space:
    """P2 on given vertex positions; vertices are numbered first, then the middles of edges.

    Attributes
    ----------
    dofs : (m, 6) numbers of each triangle's three vertices and three edge middles.
    count : how many there are.
    places : (count, 2) their points (r, z) [mm].
    values : (6, q) shape functions at the q quadrature points.
    gradients : (m, 6, q, 2) of the shape functions in (r, z) [1/mm].
    weights : (m, q) quadrature weights times area [mm²].
    rz : (m, q, 2) quadrature points [mm].
    rim : (k, 3) numbers on each boundary edge: start, end, middle.
    """

    dofs: np.ndarray
    count: int
    places: np.ndarray
    values: np.ndarray
    gradients: np.ndarray
    weights: np.ndarray
    rz: np.ndarray
    rim: np.ndarray

    @property
    def r(self) -> np.ndarray:
        """Radius of the quadrature points (m, q) [mm]."""
        return self.rz[..., 0]

    def on(self, mesh: MeridianMesh, segments: np.ndarray) -> np.ndarray:
        """Sorted numbers on the given segments of the outline, their ends included."""
        return np.unique(self.rim[np.isin(mesh.edge_segment, segments)])

    def gradient(self, field: np.ndarray) -> np.ndarray:
        """Of a field given by its numbers (count,), at the quadrature points: (m, q, 2)."""
        return np.einsum("mi,miqd->mqd", field[self.dofs], self.gradients)

    def dirichlet_matrices(self, weight: np.ndarray) -> np.ndarray:
        """∫ weight ∇u·∇v of each triangle, (m, 6, 6); weight (m, q) at the quadrature points."""
        scaled = self.gradients * (weight * self.weights)[:, None, :, None]
        m = len(self.dofs)
        left, right = scaled.reshape(m, 6, -1), self.gradients.reshape(m, 6, -1)
        return left @ right.transpose(0, 2, 1)


def quadratic(mesh: MeridianMesh, points: np.ndarray, degree: int) -> Space:
    """P2 over the mesh with its vertices at `points`, quadrature exact to a polynomial degree."""
    from skfem import Basis, ElementTriP2, MeshTri

    triangulation = MeshTri(points.T.copy(), mesh.triangles.T.copy())
    basis = Basis(triangulation, ElementTriP2(), intorder=degree)
    dofs = basis.element_dofs.T
    n = len(points)
    facets = triangulation.facets.astype(np.int64)
    low, high = np.sort(mesh.edges, axis=1).T
    order = np.lexsort(facets[::-1])
    keys = facets[0, order] * n + facets[1, order]
    rim_middle = basis.facet_dofs[0, order[np.searchsorted(keys, low * n + high)]]
    return Space(
        dofs=dofs,
        count=basis.N,
        places=basis.doflocs.T,
        values=np.stack([np.asarray(basis.basis[i][0])[0] for i in range(6)]),
        gradients=np.stack([basis.basis[i][0].grad for i in range(6)]).transpose(2, 0, 3, 1),
        weights=basis.dx,
        rz=np.moveaxis(np.asarray(basis.global_coordinates()), 0, -1),
        rim=np.column_stack([mesh.edges, rim_middle]),
    )


def summed(matrices: np.ndarray, numbers: np.ndarray, size: int) -> csc_matrix:
    """Global sparse matrix from element matrices (m, k, k); entries numbered -1 are left out."""
    k = numbers.shape[1]
    rows = np.repeat(numbers, k, axis=1).ravel()
    columns = np.tile(numbers, (1, k)).ravel()
    kept = (rows >= 0) & (columns >= 0)
    entries = (matrices.ravel()[kept], (rows[kept], columns[kept]))
    return csc_matrix(entries, shape=(size, size))


def solved(matrix: csc_matrix, load: np.ndarray) -> np.ndarray:
    """Direct solve of a symmetric positive definite system."""
    factor = splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    return factor.solve(load)


def relative_residual(matrix: csc_matrix, x: np.ndarray, load: np.ndarray) -> float:
    """‖Ax - b‖/‖b‖."""
    return float(np.linalg.norm(matrix @ x - load) / np.linalg.norm(load))
