"""Direct solves of several matrices with the same sparsity pattern, such as those of harmonics."""

from __future__ import annotations

from dataclasses import dataclass
from threading import Lock

import numpy as np
from scipy.sparse import csr_matrix

from flexspline.fea.errors import SolveError
from flexspline.fea.kept_entries import EntryPlaces, KeptEntries, starts_of
from flexspline.fea.pardiso import PardisoFactors, pardiso
from flexspline.fea.superlu import PLANE_PANEL, superlu
from flexspline.geometry.above_zero import ABOVE_ZERO

PARDISO_AT_ONCE_FROM = 800
"""Unknowns from which a matrix is Pardiso's, if it is installed, the first time its places are seen:
harmonics follow for the same places in 0.2 ms of 800, by an ordering that Pardiso has. One matrix of 800,
2 200, 5 800 unknowns takes 1.1, 3.7, 10.2 ms by Pardiso, ordering included, 0.9, 3.2, 13.3 by SuperLU, one
core. Smaller ones are mostly torsion's, one for a mesh."""
LARGEST_RESIDUAL = 1e-3
"""Largest ‖Ku − f‖/‖f‖ of a solution. SuperLU's was at most 6e-12 for 252 meridians of cups, 2.5e-6 for a
thin ring with a condition number of 1e10, and by either solver 0.0013 to 5 for grids of springs that were
held nowhere."""


@dataclass(frozen=True)
class _FreeEntries:
    """The entries of a CSR matrix between its free unknowns, and where they stand there.

    scikit-fem's `condense` finds that for each matrix: 4.7 of a harmonic's 25 ms (12 000 unknowns), 0.7 here.

    Attributes
    ----------
    free : (N,) mask. starts, columns : of the matrix of the free unknowns.
    """

    free: np.ndarray
    entries: KeptEntries
    starts: np.ndarray
    columns: np.ndarray

    @classmethod
    def of(cls, matrix: csr_matrix, free: np.ndarray) -> _FreeEntries:
        entries = KeptEntries.of(matrix, lambda rows, columns: free[rows] & free[columns])
        number = np.cumsum(free, dtype=np.int32) - 1
        return cls(free, entries, starts_of(entries.counts[free]), number[entries.columns])

    def are_of(self, matrix: csr_matrix, free: np.ndarray) -> bool:
        """Whether a matrix with these free unknowns has them at the same places."""
        return np.array_equal(free, self.free) and self.entries.places.are_of(matrix)

    def between(self, matrix: csr_matrix) -> csr_matrix:
        """The matrix of the free unknowns."""
        size = len(self.starts) - 1
        entries = (matrix.data[self.entries.kept], self.columns, self.starts)
        return csr_matrix(entries, shape=(size, size))


class PatternSolver:
    """Solves symmetric positive definite systems. Pardiso's ordering is kept as long as the entries' places
    stay."""

    def __init__(self) -> None:
        self._entries: _FreeEntries | None = None
        self._lock = Lock()  # factors serve one thread at a time
        self._factors: PardisoFactors | None = None
        self._places: EntryPlaces | None = None

    def free_part(self, matrix: csr_matrix, free: np.ndarray) -> csr_matrix:
        """Return K between the free unknowns; `free` is a mask (N,) of the unknowns of `matrix`."""
        entries = self._entries
        if entries is None or not entries.are_of(matrix, free):
            entries = self._entries = _FreeEntries.of(matrix, free)
        return entries.between(matrix)

    def solve(self, matrix: csr_matrix, loads: np.ndarray) -> np.ndarray:
        """Return K⁻¹ f of loads (N,) or (N, k).

        Raises
        ------
        RuntimeError : K is singular, in SuperLU's words.
        SolveError : it is, in Pardiso's; or the residual of the solution says so.
        """
        solution = solved(matrix, loads) if pardiso() is None else self._by_pardiso(matrix, loads)
        if not relative_residual(matrix, solution, loads) <= LARGEST_RESIDUAL:
            raise SolveError(
                "the direct solver left a residual: part of the model may be unsupported"
            )
        return solution

    def _by_pardiso(self, matrix: csr_matrix, loads: np.ndarray) -> np.ndarray:
        """K⁻¹ f; by SuperLU where K is small and its places are new."""
        with self._lock:
            last, self._factors = self._factors, None
            if last is None or not last.replace(matrix):
                before, self._places = self._places, EntryPlaces.of(matrix)
                again = before is not None and before.are_of(matrix)
                if not again and matrix.shape[0] < PARDISO_AT_ONCE_FROM:
                    return solved(matrix, loads)
                last = PardisoFactors(matrix, single=False, plane=True)
            self._factors = last
            return last.solve(loads)


def relative_residual(matrix: csr_matrix, x: np.ndarray, load: np.ndarray) -> float:
    """Return ‖Ax − b‖/‖b‖; for b = 0 that of x = 0."""
    residual, of_load = np.linalg.norm(matrix @ x - load), np.linalg.norm(load)
    return float(residual) / max(float(of_load), ABOVE_ZERO)


def solved(matrix: csr_matrix, loads: np.ndarray) -> np.ndarray:
    """Return K⁻¹ f of loads (N,) or (N, k) for a symmetric positive definite K that is used once."""
    return superlu(matrix, PLANE_PANEL).solve(loads)
