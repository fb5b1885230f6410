"""Quadratic (P2) fields on a meridian mesh: numbering, quadrature, sparse sums, solve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh, MeshingError, edge_middles
from flexspline.fea.axisymmetric.points import Points, mapped, quadrature, straight


@dataclass(frozen=True)
class Space:
    """P2 on given vertex positions; vertices are numbered first, then the middles of edges.

    Attributes
    ----------
    dofs : (m, 6) numbers of each triangle's corners, rising, and of the middles of 01, 12, 02.
    count : how many there are.
    places : (count, 2) their points (r, z) [mm].
    points : the quadrature points in each triangle.
    weights : (m, q) quadrature weights times area [mm²].
    rim : (k, 3) numbers on each boundary edge: start, end, middle.
    """

    dofs: np.ndarray
    count: int
    places: np.ndarray
    points: Points
    weights: np.ndarray
    rim: np.ndarray

    @property
    def r(self) -> np.ndarray:
        """Radius of the quadrature points (m, q) [mm]."""
        return self.points.rz[0]

    def on(self, mesh: MeridianMesh, segments: np.ndarray) -> np.ndarray:
        """Sorted numbers on the given segments of the outline, their ends included."""
        return np.unique(self.rim[np.isin(mesh.edge_segment, segments)])

    def gradient(self, field: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """∂/∂r and ∂/∂z (m, q) of a field given by its numbers (count,), at the quadrature points."""
        return self.points.gradient(field[self.dofs])

    def shape_slopes(self) -> tuple[np.ndarray, np.ndarray]:
        """∂/∂r and ∂/∂z of the shape functions at the quadrature points, each (m, 6, q) [1/mm]."""
        (_, a), (_, b) = self.points.derivative(0)
        (_, c), (_, d) = self.points.derivative(1)
        xi, eta = self.points.reference.functions[:2]
        return (
            a[:, None] * xi + b[:, None] * eta,
            c[:, None] * xi + d[:, None] * eta,
        )

    def dirichlet_matrices(self, weight: np.ndarray) -> np.ndarray:
        """∫ weight ∇u·∇v of each triangle, (m, 36); weight (m, q) at the quadrature points."""
        return self.points.dirichlet(weight * self.weights)


def isoparametric(mesh: MeridianMesh, degree: int) -> Space:
    """P2 with fillets followed by curved edges: edge middles on the arc, geometry as the fields.

    Raises
    ------
    MeshingError
        If a curved edge folds its triangle.
    """
    dofs, rim, places = _numbered(mesh, mesh.points)
    places[rim[:, 2]] = edge_middles(mesh.outline, mesh.points, mesh.edges, mesh.edge_segment)
    seen, weights = quadrature(degree)
    points = mapped(places.T[:, dofs], seen)
    # corners stand in any sense, so either sign may come, but one per triangle
    folded = (points.jacobian * points.jacobian[:, :1] <= 0).any(axis=1)
    if folded.any():
        raise MeshingError(f"{int(folded.sum())} curved triangles fold over")
    return Space(dofs, len(places), places, points, np.abs(points.jacobian) * weights, rim)


def quadratic(mesh: MeridianMesh, vertices: np.ndarray, degree: int) -> Space:
    """P2 on the mesh's straight triangles, vertices at (n, 2), quadrature of a polynomial degree."""
    dofs, rim, places = _numbered(mesh, vertices)
    seen, weights = quadrature(degree)
    points = straight(places.T[:, dofs], seen)
    return Space(dofs, len(places), places, points, np.abs(points.jacobian) * weights, rim)


def _numbered(
    mesh: MeridianMesh, vertices: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """`dofs`, `rim` and `places` of `Space`, every middle halfway between its ends."""
    n = len(vertices)
    triangles = np.sort(mesh.triangles, axis=1)
    sides = triangles[:, [0, 1, 0]] * n + triangles[:, [1, 2, 2]]
    keys, of = np.unique(sides, return_inverse=True)
    low, high = np.sort(mesh.edges, axis=1).T
    middle = n + np.searchsorted(keys, low * n + high)
    halfway = (vertices[keys // n] + vertices[keys % n]) / 2
    return (
        np.column_stack([triangles, n + of.reshape(-1, 3)]),
        np.column_stack([mesh.edges, middle]),
        np.concatenate([vertices, halfway]),
    )


def summed(matrices: np.ndarray, numbers: np.ndarray, size: int) -> csc_matrix:
    """Global sparse matrix from element matrices, k² numbers each; rows numbered -1 are left out."""
    k = numbers.shape[1]
    rows = np.repeat(numbers, k, axis=1).ravel()
    columns = np.tile(numbers, (1, k)).ravel()
    kept = (rows >= 0) & (columns >= 0)
    entries = (matrices.ravel()[kept], (rows[kept], columns[kept]))
    return csc_matrix(entries, shape=(size, size))


def solved(matrix: csc_matrix, load: np.ndarray) -> np.ndarray:
    """Direct solve of a symmetric positive definite system."""
    return factorised(matrix).solve(load)


def factorised(matrix: csc_matrix) -> SuperLU:
    """Of a symmetric positive definite matrix."""
    return splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


def relative_residual(matrix: csc_matrix, x: np.ndarray, load: np.ndarray) -> float:
    """‖Ax - b‖/‖b‖."""
    return float(np.linalg.norm(matrix @ x - load) / np.linalg.norm(load))
