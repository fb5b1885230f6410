"""Conjugate gradients for large systems: quadratic elements are smoothed, linear ones solved exactly.

The linear elements on the same corners have an eighth of the unknowns. Their matrix Pᵀ K P, with P
the interpolation of middle nodes from corners, is factorised; what it cannot see is smoothed by a
Chebyshev polynomial in B⁻¹K, B the 3 × 3 blocks of the nodes (Adams, Brezina, Hu, Tuminaro, J. Comput.
Phys. 188, 2003). Measured steps and memory: docs/decisions.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import inf

import numpy as np
from scipy.sparse import bsr_matrix, csr_matrix, diags

from flexspline.fea.errors import IterationError
from flexspline.fea.solid.assembly import NodeFrames
from flexspline.fea.solid.block_product import BlockProduct
from flexspline.fea.solid.direct import Back, factorised
from flexspline.fea.solid.iteration import conjugate_gradients, dot
from flexspline.fea.types import TetMesh

EDGES = np.array([[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]])
"""Corners at the ends of each middle node 4 to 9."""
MOST_STEPS = 1000
"""Most steps. Cups of 0.1 to 1.1 million unknowns took 22 to 93 to ‖r‖/‖f‖ of 1e-10; a thin free ring takes
the most."""
DEGREE, SMOOTHED_RATIO = 3, 10.0
"""Smoothing: products with K per pass, and the part of the spectrum it covers, largest/SMOOTHED_RATIO up."""
SPECTRUM_STEPS, SPECTRUM_SAFETY = 20, 1.1
"""Factor on the estimate of the largest eigenvalue, which is a lower bound. If it were a tenth too small, the
smoother would amplify that mode."""


def corner_interpolation(mesh: TetMesh, frames: NodeFrames) -> csr_matrix:
    """Return P (3n, 3c): every node's displacement from the corners', each in its own axes."""
    n, corners = len(mesh.nodes), int(mesh.cells[:, :4].max()) + 1
    middle, first = np.unique(mesh.cells[:, 4:].ravel(), return_index=True)
    ends = mesh.cells[:, EDGES].reshape(-1, 2)[first]
    half = [0.5 * np.matmul(frames.axes[middle].swapaxes(1, 2), frames.axes[end]) for end in ends.T]
    identity = np.broadcast_to(np.eye(3), (corners, 3, 3))
    rows = np.concatenate([np.arange(corners), middle, middle])
    columns = np.concatenate([np.arange(corners), ends[:, 0], ends[:, 1]])
    order = np.argsort(rows, kind="stable")
    blocks = np.concatenate([identity, *half])[order]
    indptr = np.searchsorted(rows[order], np.arange(n + 1))
    return bsr_matrix((blocks, columns[order], indptr), shape=(3 * n, 3 * corners)).tocsr()


class TwoLevel:
    """K of the free unknowns, prepared once for all right-hand sides; the others are 0.

    Parameters
    ----------
    matrix : K (N, N) of all unknowns, 3·node + component; 1 on the diagonal of what is not free, 0 beside it.
    free : (N,) which unknowns are.
    interpolation : (N, c) free unknowns from the corners' free ones, as `corner_interpolation`.
    exact : solves K of these.
    """

    def __init__(
        self, matrix: bsr_matrix, free: np.ndarray, interpolation: csr_matrix, exact: Back
    ) -> None:
        self._double = BlockProduct(matrix)
        # conjugate gradients tolerate the preconditioner's rounding; most of the time goes into its products
        blocks = matrix.astype(np.float32)
        self._single = BlockProduct(blocks)
        self._down = interpolation.astype(np.float32)
        self._up = self._down.T.tocsr()
        self._smooth = _Smoother(self._single, _inverse_of_nodes(blocks), free)
        self._exact = exact

    def solve(
        self, right: np.ndarray, allowed: Callable[[np.ndarray], float], worth: float = inf
    ) -> tuple[np.ndarray, float]:
        """Solve K u = f.

        Parameters
        ----------
        right : f (N,), 0 where unknowns are not free.
        allowed : of u (N,), what (u − u*)·K(u − u*) may be [N·mm].
        worth : further steps that are worth while; where its rate tells of more, the iteration ends.

        Returns
        -------
        u (N,), and a bound of (u − u*)·K(u − u*), u* exact, by the spectrum seen [N·mm].

        Raises
        ------
        IterationError : it is more than `allowed` after MOST_STEPS, or where it ended early.
        SolveError : K is not positive definite.
        """
        if not right.any():
            return np.zeros_like(right), 0.0
        solution = conjugate_gradients(
            self._double.__matmul__, self._precondition, right, MOST_STEPS, allowed, worth
        )
        # the recurrence drifts from the true residual by rounding: the energy is of the true one
        r = right - self._double @ solution.x
        left, most = dot(r, self._precondition(r)) / solution.spectrum[0], allowed(solution.x)
        if solution.early and left > most:
            raise IterationError(solution.steps, left, most)
        return solution.x, left

    def _precondition(self, residual: np.ndarray) -> np.ndarray:
        r = residual.astype(np.float32)
        x = self._smooth(r)
        x += self._down @ self._exact(self._up @ (r - self._single @ x)).astype(np.float32)
        return (x + self._smooth(r - self._single @ x)).astype(np.float64)


@contextmanager
def two_level(matrix: csr_matrix, free: np.ndarray, corners: csr_matrix) -> Iterator[TwoLevel]:
    """Give a `TwoLevel` with the corners' factors, for as long as the context lasts.

    Raises
    ------
    SolveError : there is no memory for these factors.
    """
    of_free = diags(free.astype(float))
    p = (of_free @ corners)[:, np.flatnonzero(free[: corners.shape[1]])].tocsr()  # these come first
    coarse = (p.T.tocsr() @ (matrix @ p)).tocsr()
    blocks = _uncoupled(matrix, free)
    with factorised(coarse, single=True) as exact:
        yield TwoLevel(blocks, free, p, exact)


class _Smoother:
    """Chebyshev iteration for K x = r from 0: a symmetric polynomial in B⁻¹K (Saad, 2003, alg. 12.1)."""

    def __init__(self, matrix: BlockProduct, inverse: BlockProduct, free: np.ndarray) -> None:
        self._matrix, self._inverse = matrix, inverse
        start = np.random.default_rng(0).standard_normal(len(free)).astype(np.float32) * free
        iterated = conjugate_gradients(matrix.__matmul__, inverse.__matmul__, start, SPECTRUM_STEPS)
        high = SPECTRUM_SAFETY * iterated.spectrum[1]
        low = high / SMOOTHED_RATIO
        self._middle, self._half = (high + low) / 2, (high - low) / 2

    def __call__(self, r: np.ndarray) -> np.ndarray:
        r = r.copy()
        sigma = self._middle / self._half
        rho = 1 / sigma
        step = (self._inverse @ r) / self._middle
        x = step.copy()
        for _ in range(DEGREE - 1):
            r -= self._matrix @ step
            new = 1 / (2 * sigma - rho)
            step *= new * rho
            step += (2 * new / self._half) * (self._inverse @ r)
            rho = new
            x += step
        return x


def _uncoupled(matrix: csr_matrix, free: np.ndarray) -> bsr_matrix:
    """K by nodes' blocks, with 1 on the diagonal of what is not free and 0 beside it."""
    blocks, free = matrix.tobsr((3, 3)), free.reshape(-1, 3)
    row = _rows(blocks)
    blocks.data *= free[row][:, :, None]
    blocks.data *= free[blocks.indices][:, None, :]
    blocks.data[row == blocks.indices] += np.eye(3) * ~free[:, None, :]
    return blocks


def _inverse_of_nodes(blocks: bsr_matrix) -> BlockProduct:
    """B⁻¹: the inverses of the blocks on the diagonal."""
    inverse = np.linalg.inv(blocks.data[_rows(blocks) == blocks.indices])
    n = len(inverse)
    return BlockProduct(bsr_matrix((inverse, np.arange(n), np.arange(n + 1))))


def _rows(blocks: bsr_matrix) -> np.ndarray:
    """The row of nodes (b,) of each block."""
    return np.repeat(np.arange(len(blocks.indptr) - 1), np.diff(blocks.indptr))
