"""The elastic stiffness matrix in cylindrical components at every node, from scikit-fem's forms.

∫ λ div u div v + 2μ ε(u):ε(v). With D_ij = ∫ ∂u/∂x_j ∂v/∂x_i of scalar fields, its block for component i of
the test function and j of the trial function is λ D_ij + μ D_ji + δ_ij μ (D_11 + D_22 + D_33). Six forms are
enough: D_ji is D_ij transposed. One form of vector fields gives the same matrix but takes nine times as long.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.sparse import bsr_matrix, csr_matrix
from skfem import BilinearForm

from flexspline.fea.kept_entries import NodePairs
from flexspline.fea.solid.elements import basis_of
from flexspline.fea.solid.space import SolidSpace
from flexspline.fea.types import Elastic
from flexspline.geometry.outline import SAME_mm

CHUNK_ELEMENTS = 5_000
"""Elements that are assembled at once. This limits the memory for gradients at quadrature points, which then
fit the processor's cache (42 888 elements: 1.8 s; with 20 000 at once 2.6 s)."""
CHUNK_PAIRS = 5_000
"""Pairs of nodes whose blocks are computed at once, for the same reason."""
XX = BilinearForm(lambda u, v, w: u.grad[0] * v.grad[0])
YY = BilinearForm(lambda u, v, w: u.grad[1] * v.grad[1])
ZZ = BilinearForm(lambda u, v, w: u.grad[2] * v.grad[2])
XY = BilinearForm(lambda u, v, w: u.grad[1] * v.grad[0])
XZ = BilinearForm(lambda u, v, w: u.grad[2] * v.grad[0])
YZ = BilinearForm(lambda u, v, w: u.grad[2] * v.grad[1])
FORMS = {(0, 0): XX, (1, 1): YY, (2, 2): ZZ, (0, 1): XY, (0, 2): XZ, (1, 2): YZ}


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
        on_axis = radius < SAME_mm
        safe = np.where(on_axis, 1.0, radius)
        c = np.where(on_axis, 1.0, nodes[:, 0] / safe)
        s = np.where(on_axis, 0.0, nodes[:, 1] / safe)
        axes = np.zeros((len(nodes), 3, 3))
        axes[:, 0, 0], axes[:, 1, 0] = c, s
        axes[:, 0, 1], axes[:, 1, 1] = -s, c
        axes[:, 2, 2] = 1.0
        return cls(axes, np.where(on_axis, 0.0, radius))

    def to_cartesian(self, u: np.ndarray) -> np.ndarray:
        """Return vectors (n, 3) in Cartesian components, from cylindrical ones."""
        return np.einsum("nab,nb->na", self.axes, u)

    def to_cylindrical(self, u: np.ndarray) -> np.ndarray:
        """Return vectors (n, 3) in cylindrical components, from Cartesian ones."""
        return np.einsum("nab,na->nb", self.axes, u)


def stiffness_matrix(space: SolidSpace, material: Elastic, frames: NodeFrames) -> csr_matrix:
    """Return the symmetric matrix (3n, 3n) N/mm; unknown 3·node + component."""
    n = len(space.node)
    pairs, d = _derivatives(space)
    row, column = pairs // n, pairs % n
    data = np.empty((len(pairs), 3, 3))
    for start in range(0, len(pairs), CHUNK_PAIRS):
        part = slice(start, start + CHUNK_PAIRS)
        blocks = _blocks({ij: entries[part] for ij, entries in d.items()}, material)
        _turn(blocks, frames, row[part], column[part])
        data[part] = blocks.transpose(2, 0, 1)
    del d  # as large as the matrix
    starts = np.searchsorted(row, np.arange(n + 1))
    return bsr_matrix((data, column, starts), shape=(3 * n, 3 * n)).tocsr()


def _blocks(d: Mapping[tuple[int, int], np.ndarray], material: Elastic) -> np.ndarray:
    """Blocks (3, 3, p) of node pairs, of D_ij (p,)."""
    blocks = np.empty((3, 3, len(d[0, 0])))
    trace = material.mu * (d[0, 0] + d[1, 1] + d[2, 2])
    for i, j in np.ndindex(3, 3):
        blocks[i, j] = material.lam * d[i, j] + material.mu * d[j, i]
    for i in range(3):
        blocks[i, i] += trace
    return blocks


def _derivatives(
    space: SolidSpace,
) -> tuple[np.ndarray, dict[tuple[int, int], np.ndarray]]:
    """Pairs of nodes (p,) that share an element, row·n + column rising, and D_ij (p,) for each."""
    n, m = len(space.node), len(space.cells)
    pairs = NodePairs.of(space.cells, n)
    d = {ij: np.zeros(len(pairs.number)) for ij in FORMS}
    for start in range(0, m, CHUNK_ELEMENTS):
        part = np.arange(start, min(start + CHUNK_ELEMENTS, m))
        basis = basis_of(space.curved, elements=part)
        for ij, form in FORMS.items():
            d[ij] += pairs.summed(form.elemental(basis).data, part)
    opposite = {(j, i): entries[pairs.transposed] for (i, j), entries in d.items() if i != j}
    return pairs.number, d | opposite


def _turn(blocks: np.ndarray, frames: NodeFrames, row: np.ndarray, column: np.ndarray) -> None:
    """Blocks (3, 3, p) of node pairs into the nodes' own axes, in place: AᵢᵀK Aⱼ about z."""
    c, s = frames.axes[:, 0, 0], frames.axes[:, 1, 0]
    x, y = blocks[0].copy(), blocks[1].copy()
    blocks[0], blocks[1] = c[row] * x + s[row] * y, c[row] * y - s[row] * x
    x, y = blocks[:, 0].copy(), blocks[:, 1].copy()
    blocks[:, 0], blocks[:, 1] = c[column] * x + s[column] * y, c[column] * y - s[column] * x
