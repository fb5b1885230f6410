"""Quadratic tetrahedra through scikit-fem: bases, volumes, facet integrals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


def linear_mesh(corners: np.ndarray, tets: np.ndarray) -> Any:
    """scikit-fem's MeshTet; corners (n, 3), tets (m, 4)."""
    from flexspline.fea.entities import Tetrahedra

    return Tetrahedra(np.ascontiguousarray(corners.T), np.ascontiguousarray(tets.T), sort_t=False)


def quadratic_mesh(nodes: np.ndarray, cells: np.ndarray) -> Any:
    """scikit-fem's curved MeshTet2; it numbers the middle nodes by its own edges."""
    from flexspline.fea.entities import CurvedTetrahedra

    return CurvedTetrahedra(
        np.ascontiguousarray(nodes.T), np.ascontiguousarray(cells.T), sort_t=False
    )


def basis_of(
    curved: Any,
    elements: np.ndarray | None = None,
    quadrature: tuple[np.ndarray, np.ndarray] | None = None,
) -> Any:
    """scikit-fem's basis on all or some elements of a `quadratic_mesh`.

    `quadrature` is points (q, 3) and weights (q,); degree 4 when absent, exact for P2 on straight edges.
    The nodes have scikit-fem's numbers; an element's ten are in the order of `TetMesh.cells`.
    """
    from skfem import Basis, ElementTetP2, ElementTriP2

    from flexspline.fea.solid.mapping import KeptMapping

    points, weights = quadrature or tet_rule(4)
    element = ElementTetP2()
    return Basis(
        curved, element, mapping=KeptMapping(curved, element, ElementTriP2()),
        quadrature=(np.ascontiguousarray(points.T), weights), elements=elements,
        dofs=curved.dofs, disable_doflocs=True,
    )  # fmt: skip


def displacement_gradient(basis: Any, u_cells: np.ndarray) -> np.ndarray:
    """∂u_a/∂x_b (m, q, a, b) at the basis's points, from the elements' ten displacements (m, 10, 3)."""
    slopes = np.stack([function.grad.transpose(1, 2, 0) for (function,) in basis.basis], axis=2)
    return np.matmul(u_cells.transpose(0, 2, 1)[:, None], slopes)


def _jacobians(nodes: np.ndarray, cells: np.ndarray, local: np.ndarray) -> np.ndarray:
    """dx/dξ, (m, q, 3, 3)."""
    q = len(local)
    flat = local.transpose(0, 2, 1).reshape(3 * q, 10)  # one matrix product for all points
    found = np.matmul(flat, nodes[cells]).reshape(len(cells), q, 3, 3)
    return found.swapaxes(2, 3)


def _determinants(j: np.ndarray) -> np.ndarray:
    """Of 3×3 matrices (..., 3, 3): the first row times the cross product of the others."""
    (a, b, c), (d, e, f), (g, h, k) = ((j[..., i, 0], j[..., i, 1], j[..., i, 2]) for i in range(3))
    return a * (e * k - f * h) + b * (f * g - d * k) + c * (d * h - e * g)


def _weights(
    nodes: np.ndarray, cells: np.ndarray, points: np.ndarray, weights: np.ndarray
) -> np.ndarray:
    """w·det J (m, q) mm³.

    Meshes are checked with it again and again, and scikit-fem's map takes 2 to 4 times as long (12 600
    elements: 0.12 s against 0.05, volumes 0.09 against 0.02).
    """
    return _determinants(_jacobians(nodes, cells, reference_gradients(points))) * weights


def reference_gradients(points: np.ndarray) -> np.ndarray:
    """d φ_i / d ξ at reference points: (q, 10, 3); scikit-fem's ElementTetP2."""
    from skfem import ElementTetP2

    element = ElementTetP2()
    return np.stack([element.lbasis(points.T, i)[1].T for i in range(10)], axis=1)


def reference_values(points: np.ndarray) -> np.ndarray:
    """φ_i at reference points: (q, 10)."""
    from skfem import ElementTetP2

    element = ElementTetP2()
    return np.stack([element.lbasis(points.T, i)[0] for i in range(10)], axis=1)


def tet_rule(degree: int) -> tuple[np.ndarray, np.ndarray]:
    """Quadrature points (q, 3) and weights (q,) on the reference tetrahedron."""
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefTet

    points, weights = get_quadrature(RefTet, degree)
    return points.T, weights


NODES = np.array(
    [
        [0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1],
        [0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0], [0, 0, 0.5], [0.5, 0, 0.5], [0, 0.5, 0.5],
    ]
)  # fmt: skip
"""Reference coordinates of the ten nodes."""


def jacobian_ratio(nodes: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Smallest over largest det J at the nodes and quadrature points, per element (m,).

    1 for straight edges, 0 or less where curving has folded the element.
    """
    points = np.vstack([NODES, tet_rule(4)[0]])
    det = _weights(nodes, cells, points, np.ones(len(points)))
    return det.min(axis=1) / np.abs(det).max(axis=1)


def element_volumes(nodes: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Volumes of curved elements (m,) mm³."""
    return _weights(nodes, cells, *tet_rule(4)).sum(axis=1)


@dataclass(frozen=True)
class FacetPoints:
    """Quadrature on six-node facets: points (k, q, 3) mm, values (q, 6), weights·area (k, q) mm²."""

    points: np.ndarray
    values: np.ndarray
    weights: np.ndarray


def facet_points(nodes: np.ndarray, facets: np.ndarray, degree: int = 4) -> FacetPoints:
    """Quadrature points of curved facets."""
    from skfem import ElementTriP2
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefTri

    where, weights = get_quadrature(RefTri, degree)
    element = ElementTriP2()
    pairs = [element.lbasis(where, i) for i in range(6)]
    values = np.stack([p[0] for p in pairs], axis=1)
    local = np.stack([p[1].T for p in pairs], axis=1)  # (q, 6, 2)
    x = nodes[facets]
    tangents = np.einsum("kix,qij->kqjx", x, local)
    area = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=2)
    return FacetPoints(np.einsum("qi,kix->kqx", values, x), values, area * weights)


def facet_areas(nodes: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """Areas (k,) mm² of six-node facets."""
    return facet_points(nodes, facets).weights.sum(axis=1)
