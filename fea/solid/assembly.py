"""The elastic stiffness matrix in cylindrical components at every node.

∫ λ div u div v + 2μ ε(u):ε(v), from the basis gradients as one batched product
D_ij = Σ_q w ∇φ_i ⊗ ∇φ_j, of which the block for nodes i, j is λ D + μ Dᵀ + μ tr(D) I.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import bsr_matrix, csr_matrix

from fea.solid.elements import mesh_gradients
from fea.types import Elastic, TetMesh

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
    blocks = np.zeros((len(pairs), 9))
    for start in range(0, len(mesh.cells), CHUNK):
        part = slice(start, start + CHUNK)
        local = _element_blocks(mesh, part, material, frames).reshape(-1, 9)
        where = slot[start * 100 : start * 100 + len(local)]
        for k in range(9):
            blocks[:, k] += np.bincount(where, local[:, k], minlength=len(pairs))
    indptr = np.searchsorted(pairs // n, np.arange(n + 1))
    return bsr_matrix((blocks.reshape(-1, 3, 3), pairs % n, indptr), shape=(3 * n, 3 * n)).tocsr()


def _element_blocks(
    mesh: TetMesh, part: slice, material: Elastic, frames: NodeFrames
) -> np.ndarray:
    """(m, 10, 10, 3, 3) blocks of a slice of elements, in the nodes' own axes."""
    cells = mesh.cells[part]
    g = mesh_gradients(
        TetMesh(mesh.nodes, cells, mesh.facets, mesh.facet_patch, mesh.patches, mesh.sector_deg)
    )
    m, q = g.weights.shape
    flat = g.gradients.reshape(m, q, 30)
    d = np.matmul((flat * g.weights[..., None]).transpose(0, 2, 1), flat)
    d = d.reshape(m, 10, 3, 10, 3).transpose(0, 1, 3, 2, 4)
    trace = np.trace(d, axis1=3, axis2=4)
    local = material.lam * d + material.mu * d.swapaxes(3, 4)
    local += material.mu * trace[..., None, None] * np.eye(3)
    axes = frames.axes[cells]
    left = np.matmul(axes.swapaxes(2, 3)[:, :, None], local)
    return np.matmul(left, axes[:, None])
