"""Direct solves of one matrix after the other whose entries lie at the same places, as those of harmonics."""

from __future__ import annotations

from threading import Lock

import numpy as np
from scipy.sparse import csr_matrix

from flexspline.fea.pardiso import PardisoFactors, pardiso
from flexspline.fea.superlu import superlu

PARDISO_FROM = 3_000
"""Unknowns from which oneMKL's Pardiso takes less time than SuperLU, where it is. Milliseconds of SuperLU, of
Pardiso's factors, and of those with a new ordering, on a busy machine: 1 000 to 2 000 unknowns 9, 15 and 22,
2 000 to 4 000 19, 14 and 35, 4 000 to 8 000 53, 25 and 64, 8 000 to 16 000 147, 58 and 115. Four of five
matrices have the places of the last one."""


class PatternSolver:
    """Of symmetric positive definite systems; the ordering stays while the entries' places do."""

    def __init__(self) -> None:
        self._lock = Lock()  # factors serve one thread at a time
        self._factors: PardisoFactors | None = None

    def solve(self, matrix: csr_matrix, loads: np.ndarray) -> np.ndarray:
        """K⁻¹ f of loads (N,) or (N, k).

        Raises
        ------
        RuntimeError : K is singular, in SuperLU's words.
        SolveError : it is, in Pardiso's.
        """
        if matrix.shape[0] < PARDISO_FROM or pardiso() is None:
            return solved(matrix, loads)
        with self._lock:
            last, self._factors = self._factors, None
            if last is None or not last.replace(matrix):
                last = PardisoFactors(matrix, single=False)
            self._factors = last
            return last.solve(loads)


def solved(matrix: csr_matrix, loads: np.ndarray) -> np.ndarray:
    """K⁻¹ f of loads (N,) or (N, k), K symmetric positive definite, once."""
    return superlu(matrix).solve(loads)
