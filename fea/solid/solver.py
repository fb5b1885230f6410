"""Sparse direct solution with prescribed unknowns, and the checks that follow every solve."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix, triu

from fea.solid.errors import SolveError

RESIDUAL_LIMIT = 1e-8
"""‖Ku − f‖/‖f‖ accepted: a direct solve of a well-posed part gives 1e-12 to 1e-10."""


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
    SolveError : the relative residual is above RESIDUAL_LIMIT or not finite.
    """
    u = np.zeros(matrix.shape[0])
    u[fixed] = values
    free = np.setdiff1d(np.arange(matrix.shape[0]), fixed, assume_unique=True)
    rows = matrix[free]
    right = load[free] - rows @ u
    inner = rows[:, free].tocsr()
    u[free] = _direct(inner, right)
    off = float(np.linalg.norm(inner @ u[free] - right))
    residual = off / max(float(np.linalg.norm(right)), 1e-300)
    if not residual < RESIDUAL_LIMIT:
        raise SolveError(
            f"relative residual {residual:.1e} after the solve, allowed {RESIDUAL_LIMIT:.0e}:"
            " part of the model may be unsupported"
        )
    return Solution(u, matrix @ u - load, residual, len(free))


def _direct(matrix: csr_matrix, right: np.ndarray) -> np.ndarray:
    solver = _pardiso()
    if solver is None:
        from scipy.sparse.linalg import splu

        return splu(
            matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}
        ).solve(right)
    try:
        upper = triu(matrix, format="csr")
        upper.sort_indices()
        return solver.solve(upper, right)
    finally:
        solver.free_memory(everything=True)


@cache
def _pardiso() -> Any:
    """pypardiso's solver, or None where MKL does not exist (Arm); finding MKL takes 0.2 s."""
    try:
        from pypardiso import PyPardisoSolver
    except (ImportError, OSError):
        return None
    return PyPardisoSolver(mtype=2)  # real, symmetric, positive definite: upper triangle only
