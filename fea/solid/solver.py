"""Sparse direct solution with prescribed unknowns, and the checks that follow every solve."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix, triu

from fea.solid.errors import SolveError

LOST_ENERGY_LIMIT = 1e-6
"""Largest |u·(Ku − f)| over u·Ku, as in `fea.axisymmetric.harmonics`: the ‖Ku − f‖/‖f‖ of a thin part
that a load bends is large by rounding alone (2e-8 for a roof of one layer), the energy is not."""

PARDISO_OUT_OF_MEMORY = -2


@dataclass(frozen=True)
class Solution:
    """Unknowns (N,), reactions Ku − f (N,) on the prescribed ones, and the relative residual."""

    unknowns: np.ndarray
    reactions: np.ndarray
    residual: float
    free_count: int


def solve(matrix: csr_matrix, load: np.ndarray, fixed: np.ndarray, values: np.ndarray) -> Solution:
    """Solve K u = f with u[fixed] = values.

    Parameters
    ----------
    matrix : (N, N) symmetric positive definite once the fixed unknowns are removed.
    load : (N,) N. fixed : (k,) indices, unique. values : (k,) mm.

    Raises
    ------
    SolveError : the factorisation failed, or the solve loses energy: the part is not supported.
    """
    u = np.zeros(matrix.shape[0])
    u[fixed] = values
    free = np.setdiff1d(np.arange(matrix.shape[0]), fixed, assume_unique=True)
    rows = matrix[free]
    right = load[free] - rows @ u
    inner = rows[:, free].tocsr()
    u[free] = _direct(inner, right)
    off = inner @ u[free] - right
    residual = float(np.linalg.norm(off)) / max(float(np.linalg.norm(right)), 1e-300)
    lost = abs(float(u[free] @ off)) / max(float(u @ (matrix @ u)), 1e-300)
    if not lost < LOST_ENERGY_LIMIT:
        raise SolveError(
            f"{lost:.1e} of the energy is lost in the solve, allowed {LOST_ENERGY_LIMIT:.0e}"
            f" (relative residual {residual:.1e}): part of the model may be unsupported"
        )
    return Solution(u, matrix @ u - load, residual, len(free))


def _direct(matrix: csr_matrix, right: np.ndarray) -> np.ndarray:
    solver = _pardiso()
    if solver is None:
        return _superlu(matrix, right)
    from pypardiso.pardiso_wrapper import PyPardisoError

    upper = triu(matrix, format="csr")
    upper.sort_indices()
    try:
        return solver.solve(upper, right)
    except PyPardisoError as error:
        if error.value == PARDISO_OUT_OF_MEMORY:
            raise SolveError(
                f"the direct solver has no memory for {matrix.shape[0]} unknowns:"
                " raise solver.tolerance_pct or solver.edge_length_mm"
            ) from error
        raise SolveError(
            f"the direct solver stopped ({error}): part of the model may be unsupported"
        ) from error
    finally:
        solver.free_memory(everything=True)


def _superlu(matrix: csr_matrix, right: np.ndarray) -> np.ndarray:
    from scipy.sparse.linalg import splu

    options = {"SymmetricMode": True}
    return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options=options).solve(right)


@cache
def _pardiso() -> Any:
    """pypardiso's solver, or None where MKL does not exist (Arm)."""
    # pypardiso would search the whole environment for MKL, twice, 0.3 s: it lies where wheels put it
    for library in sorted(Path(sys.prefix, "lib").glob("libmkl_rt*")):
        os.environ.setdefault("PYPARDISO_MKL_RT", str(library))
    try:
        from pypardiso import PyPardisoSolver
    except (ImportError, OSError):
        return None
    return PyPardisoSolver(mtype=2)  # real, symmetric, positive definite: upper triangle only
