"""Quadratic tetrahedra through scikit-fem: bases, curvature of elements."""

from __future__ import annotations

from typing import Any

import numpy as np

CHUNK_CELLS = 1_000
"""Cells whose Jacobians are computed at once: 1.5 MB, which fit the processor's cache."""


def basis_of(
    curved: Any,
    elements: np.ndarray | None = None,
    quadrature: tuple[np.ndarray, np.ndarray] | None = None,
) -> Any:
    """Return scikit-fem's basis on all or some elements of a `SolidSpace.curved`.

    `quadrature` is points (q, 3) and weights (q,); degree 4 when absent, exact for P2 on straight edges.
    The nodes have scikit-fem's numbers; an element's ten are in the order of `TetMesh.cells`.
    """
    from skfem import Basis, ElementTetP2

    points, weights = quadrature or tet_rule()
    return Basis(
        curved, ElementTetP2(), quadrature=(np.ascontiguousarray(points.T), weights),
        elements=elements, dofs=curved.dofs, disable_doflocs=True,
    )  # fmt: skip


def displacement_gradient(basis: Any, u_cells: np.ndarray) -> np.ndarray:
    """Return ∂u_a/∂x_b (m, q, a, b) at the basis's points from ten displacements (m, 10, 3)."""
    slopes = np.stack([function.grad.transpose(1, 2, 0) for (function,) in basis.basis], axis=2)
    return np.matmul(u_cells.transpose(0, 2, 1)[:, None], slopes)


def determinants(nodes: np.ndarray, cells: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return det ∂x/∂ξ (m, q) mm³ at reference points (q, 3); it is negative where a cell is folded."""
    from skfem import ElementTetP2
    from skfem.helpers import det

    element = ElementTetP2()
    slopes = np.stack([element.lbasis(points.T, i)[1] for i in range(10)], axis=2)
    dets = np.empty((len(cells), len(points)))
    for start in range(0, len(cells), CHUNK_CELLS):
        part = slice(start, start + CHUNK_CELLS)
        places = nodes[cells[part]].transpose(2, 1, 0)
        jacobian = np.matmul(slopes.reshape(-1, 10), places)  # of each coordinate
        dets[part] = det(jacobian.reshape(3, 3, len(points), -1)).T
    return dets


def reference_values(points: np.ndarray) -> np.ndarray:
    """Return φ_i (q, 10) at reference points."""
    from skfem import ElementTetP2

    element = ElementTetP2()
    return np.stack([element.lbasis(points.T, i)[0] for i in range(10)], axis=1)


def tet_rule() -> tuple[np.ndarray, np.ndarray]:
    """Return quadrature points (q, 3) and weights (q,) of degree 4 on the reference tetrahedron."""
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefTet

    points, weights = get_quadrature(RefTet, 4)
    return points.T, weights


NODES = np.array(
    [
        [0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1],
        [0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0], [0, 0, 0.5], [0.5, 0, 0.5], [0, 0.5, 0.5],
    ]
)  # fmt: skip
"""Reference coordinates of the ten nodes."""


def jacobian_ratio(nodes: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return the smallest over the largest det J at nodes and quadrature points of each element (m,).

    1 for straight edges, 0 or less where curving has folded the element.
    """
    dets = determinants(nodes, cells, np.vstack([NODES, tet_rule()[0]]))
    return dets.min(axis=1) / np.abs(dets).max(axis=1)
