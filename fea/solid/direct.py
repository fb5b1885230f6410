"""Sparse factorisation of symmetric positive definite matrices: Pardiso, or SuperLU where MKL is not."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix, triu

from flexspline.fea.solid.errors import SolveError

Back = Callable[[np.ndarray], np.ndarray]
PARDISO_OUT_OF_MEMORY = -2
"""oneMKL's code for "not enough memory"."""


@contextmanager
def factorised(matrix: csr_matrix) -> Iterator[Back]:
    """K⁻¹ as a function of the right-hand side (N,), for as long as the context lasts.

    Raises
    ------
    SolveError : K is not positive definite, or the factors do not fit the memory.
    """
    make = pardiso()
    if make is None:
        yield _superlu(matrix)
        return
    from pypardiso.pardiso_wrapper import PyPardisoError

    upper = triu(matrix, format="csr")
    upper.sort_indices()
    solver = make(mtype=2)  # real, symmetric, positive definite: upper triangle only
    try:
        solver.factorize(upper)
        yield lambda right: solver.solve(upper, right)
    except PyPardisoError as error:
        raise _said(error, matrix.shape[0]) from error
    finally:
        solver.free_memory(everything=True)


def direct(matrix: csr_matrix, right: np.ndarray) -> np.ndarray:
    """Solve K u = f once.

    Raises
    ------
    SolveError : as `factorised`.
    """
    make = pardiso()
    if make is None:
        return _superlu(matrix)(right)
    from pypardiso.pardiso_wrapper import PyPardisoError

    upper = triu(matrix, format="csr")
    upper.sort_indices()
    solver = make(mtype=2)
    try:
        return solver.solve(upper, right)  # unlike factorize, it keeps no copy of the matrix
    except PyPardisoError as error:
        raise _said(error, matrix.shape[0]) from error
    finally:
        solver.free_memory(everything=True)


def _said(error: Any, unknowns: int) -> SolveError:
    if error.value == PARDISO_OUT_OF_MEMORY:
        return SolveError(
            f"the direct solver has no memory for {unknowns} unknowns:"
            " raise solver.tolerance_pct or solver.edge_length_mm"
        )
    return SolveError(f"the direct solver stopped ({error}): part of the model may be unsupported")


def _superlu(matrix: csr_matrix) -> Back:
    from scipy.sparse.linalg import splu

    options = {"SymmetricMode": True}
    return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options=options).solve


@cache
def pardiso() -> Any:
    """pypardiso's solver class, or None where MKL does not exist (Arm)."""
    # pypardiso would search the whole environment for MKL, twice, 0.3 s, and not the one that a virtual
    # environment may share packages with: it lies where wheels put it
    for prefix in (sys.prefix, sys.base_prefix):
        for library in sorted(Path(prefix, "lib").glob("libmkl_rt*")):
            os.environ.setdefault("PYPARDISO_MKL_RT", str(library))
    try:
        from pypardiso import PyPardisoSolver

        PyPardisoSolver(mtype=2)  # loads the library
    except (ImportError, OSError):
        return None
    return PyPardisoSolver
