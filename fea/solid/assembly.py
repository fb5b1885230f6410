"""The elastic stiffness matrix in cylindrical components at every node.

∫ λ div u div v + 2μ ε(u):ε(v), from the basis gradients as one batched product
D_ij = Σ_q w ∇φ_i ⊗ ∇φ_j, of which the block for nodes i, j is λ D + μ Dᵀ + μ tr(D) I.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import bsr_matrix, csr_matrix

from flexspline.fea.solid.elements import mesh_gradients
from flexspline.fea.types import Elastic, TetMesh

CHUNK = 20_000
"""Elements handled at once: bounds the memory of the batched product."""


@dataclass(frozen=True)
class NodeFrames:
    """Orthonormal axes (n, 3, 3) at every node, columns radial, tangential, axial.

    On the axis of revolution the first two are x and y.
    """

    axes: np.ndarray
    radius: np.ndarray

    @classmethod
    def cylindrical(cls, nodes: np.ndarray) -> NodeFrames:
        radius = np.hypot(nodes[:, 0], nodes[:, 1])
        on_axis = radius < 1e-9
        safe = np.where(on_axis, 1.0, radius)
        c = np.where(on_axis, 1.0, nodes[:, 0] / safe)
        s = np.where(on_axis, 0.0, nodes[:, 1] / safe)
        axes = np.zeros((len(nodes), 3, 3))
        axes[:, 0, 0], axes[:, 1, 0] = c, s
        axes[:, 0, 1], axes[:, 1, 1] = -s, c
        axes[:, 2, 2] = 1.0
        return cls(axes, np.where(on_axis, 0.0, radius))

    def to_cartesian(self, u: np.ndarray) -> np.ndarray:
        """(n, 3) cylindrical to (n, 3) Cartesian components."""
        return np.einsum("nab,nb->na", self.axes, u)


def stiffness_matrix(mesh: TetMesh, material: Elastic, frames: NodeFrames) -> csr_matrix:
    """Symmetric matrix (3n, 3n) N/mm; unknown 3·node + component."""
    n = len(mesh.nodes)
    rows = np.repeat(mesh.cells, 10, axis=1).ravel()
    columns = np.tile(mesh.cells, (1, 10)).ravel()
    pairs, slot = np.unique(rows * n + columns, return_inverse=True)
    blocks = np.zeros((3, 3, len(pairs)))
    for start in range(0, len(mesh.cells), CHUNK):
        local = _element_blocks(mesh, slice(start, start + CHUNK), material)
        where = slot[start * 100 : start * 100 + local[0, 0].size]
        for a, b in np.ndindex(3, 3):
            blocks[a, b] += np.bincount(where, local[a, b].ravel(), minlength=len(pairs))
    _turn(blocks, frames, pairs // n, pairs % n)
    indptr = np.searchsorted(pairs // n, np.arange(n + 1))
    data = np.ascontiguousarray(blocks.transpose(2, 0, 1))
    return bsr_matrix((data, pairs % n, indptr), shape=(3 * n, 3 * n)).tocsr()


def _element_blocks(mesh: TetMesh, part: slice, material: Elastic) -> np.ndarray:
    """(3, 3, m, 10, 10): Cartesian component pair, element, node pair."""
    cells = mesh.cells[part]
    g = mesh_gradients(
        TetMesh(mesh.nodes, cells, mesh.facets, mesh.facet_patch, mesh.patches, mesh.sector_deg)
    )
    m, q = g.weights.shape
    flat = g.gradients.transpose(0, 1, 3, 2).reshape(m, q, 30)
    d = np.matmul((flat * g.weights[..., None]).transpose(0, 2, 1), flat)
    # one contiguous (m, 10, 10) for every component pair: all that follows is plain sums
    d = np.ascontiguousarray(d.reshape(m, 3, 10, 3, 10).transpose(1, 3, 0, 2, 4))
    local = material.lam * d + material.mu * d.swapaxes(0, 1)
    trace = material.mu * (d[0, 0] + d[1, 1] + d[2, 2])
    for a in range(3):
        local[a, a] += trace
    return local


def _turn(blocks: np.ndarray, frames: NodeFrames, row: np.ndarray, column: np.ndarray) -> None:
    """Blocks (3, 3, p) of node pairs into the nodes' own axes, in place: AᵢᵀK Aⱼ about z."""
    c, s = frames.axes[:, 0, 0], frames.axes[:, 1, 0]
    x, y = blocks[0].copy(), blocks[1].copy()
    blocks[0], blocks[1] = c[row] * x + s[row] * y, c[row] * y - s[row] * x
    x, y = blocks[:, 0].copy(), blocks[:, 1].copy()
    blocks[:, 0], blocks[:, 1] = c[column] * x + s[column] * y, c[column] * y - s[column] * x
