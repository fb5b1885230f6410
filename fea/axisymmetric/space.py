"""Quadratic (P2) fields on a meridian mesh: numbering, gradients, sparse sums, solve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from fea.axisymmetric.meridian_mesh import MeridianMesh, MeshingError, edge_middles


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


def isoparametric(mesh: MeridianMesh, degree: int) -> Space:
    """P2 with fillets followed by curved edges: edge middles on the arc, geometry as the fields.

    Raises
    ------
    MeshingError
        If a curved edge folds its triangle.
    """
    from skfem import ElementTriP2
    from skfem.quadrature import get_quadrature

    straight = quadratic(mesh, mesh.points, 1)
    places = straight.places.copy()
    places[straight.rim[:, 2]] = edge_middles(
        mesh.outline, mesh.points, mesh.edges, mesh.edge_segment
    )
    at, weights = get_quadrature(ElementTriP2, degree)
    values, slopes = reference_shape(at)
    gradients, jacobian, rz = mapped(places[straight.dofs], values, slopes)
    # scikit-fem sorts corners by number, so either sign may come, but one per triangle
    folded = (jacobian * jacobian[:, :1] <= 0).any(axis=1)
    if folded.any():
        raise MeshingError(f"{int(folded.sum())} curved triangles fold over")
    return Space(
        straight.dofs,
        straight.count,
        places,
        values,
        gradients,
        np.abs(jacobian) * weights,
        rz,
        straight.rim,
    )


def reference_shape(at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """P2 values (6, q) and slopes (6, q, 2) at points (2, q) of the reference triangle."""
    from skfem import ElementTriP2

    parts = [ElementTriP2().lbasis(at, i) for i in range(6)]
    values = np.stack([np.broadcast_to(v, at.shape[1]) for v, _ in parts])
    slopes = np.stack([np.stack([np.broadcast_to(c, at.shape[1]) for c in g], 1) for _, g in parts])
    return values, slopes


def mapped(
    nodes: np.ndarray, values: np.ndarray, slopes: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gradients (m, 6, q, 2), Jacobians (m, q) and points (m, q, 2) of six-node triangles."""
    jacobian = np.einsum("mid,iqe->mqde", nodes, slopes)
    (a, b), (c, d) = np.moveaxis(jacobian, (2, 3), (0, 1))
    det = a * d - b * c
    inverse = np.stack([np.stack([d, -b], -1), np.stack([-c, a], -1)], -2) / det[..., None, None]
    gradients = np.einsum("iqe,mqed->miqd", slopes, inverse)
    return gradients, det, np.einsum("mid,iq->mqd", nodes, values)


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
