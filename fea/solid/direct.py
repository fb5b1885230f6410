"""Sparse factorisation of symmetric positive definite matrices: Pardiso, or SuperLU where MKL is not.

A large system's factors are in single precision, half the memory and half the time, and precondition
conjugate gradients in double.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix

from flexspline.fea.solid.errors import SolveError
from flexspline.fea.solid.iteration import conjugate_gradients, dot
from flexspline.fea.solid.mkl import address, mkl

Back = Callable[[np.ndarray], np.ndarray]
PARDISO_OUT_OF_MEMORY = -2
"""oneMKL's code for "not enough memory"."""
SYMMETRIC_POSITIVE = 2
"""oneMKL's matrix type: its upper triangle is given."""
ANALYSE_AND_FACTORISE, SUBSTITUTE, RELEASE = 12, 33, -1
"""oneMKL's phases."""
SETTINGS = {0: 1, 1: 2, 7: 0, 9: 8, 20: 1, 23: 1, 34: 1}
"""iparm by its number from 0; not oneMKL's defaults: factors by its two-level method (23), 0.7 to 1.05 of
the seconds of factors, and numbers from 0 (34)."""
IN_SINGLE = 27
"""iparm: factors, matrix and right-hand sides of four bytes."""
SINGLE_FROM = 10_000
"""Unknowns from which `direct` factorises in single precision: smaller ones take 0.1 s in double."""
FACTORED_ENERGY = 1e-15
"""Energy of the error over f·u at which the steps with factors in single precision end: that of factors in
double is 1e-29 in torsion, 1e-16 in a thin free rim."""
FACTORED_ROUNDS = 2
"""The second begins with the true residual, one step as a rule: the first one's rounding takes K of a free
rim off by 1e-8, and that step leaves 2e-10."""
FACTORED_STEPS = 30
"""At most: 2 to 3 in torsion, 3 to 4 on the ellipse, 4 to 15 in free rims (walls of 1/80 to 1/370 of the
diameter, 24 000 to 216 000 unknowns)."""


class PardisoFactors:
    """Pardiso's factors of a matrix, until they are released."""

    def __init__(self, matrix: csr_matrix, single: bool) -> None:
        self._pt = np.zeros(64, np.int64)
        self._iparm = np.zeros(64, np.int32)
        for number, value in SETTINGS.items():
            self._iparm[number] = value
        self._iparm[IN_SINGLE] = single
        self._type = np.float32 if single else np.float64
        self._data, self._columns, self._starts = _upper(matrix, self._type)
        try:
            self._call(ANALYSE_AND_FACTORISE, np.zeros(matrix.shape[0]))
        except SolveError:
            self.release()
            raise

    def solve(self, right: np.ndarray) -> np.ndarray:
        """K⁻¹ f (N,), in double whatever the factors are."""
        return self._call(SUBSTITUTE, right)

    def release(self) -> None:
        self._call(RELEASE, np.zeros(len(self._starts) - 1))

    def _call(self, phase: int, right: np.ndarray) -> np.ndarray:
        b = np.ascontiguousarray(right, self._type)
        x, error = np.zeros_like(b), ctypes.c_int32(0)
        one, silent = _pointer(1), _pointer(0)
        pt, data, starts, columns = map(
            address, (self._pt, self._data, self._starts, self._columns)
        )
        pardiso()(
            pt, one, one, _pointer(SYMMETRIC_POSITIVE), _pointer(phase), _pointer(len(b)),
            data, starts, columns, None, one, address(self._iparm), silent,
            address(b), address(x), ctypes.byref(error),
        )  # fmt: skip
        if error.value:
            raise _said(error.value, len(b))
        return x.astype(np.float64)


def _pointer(value: int) -> Any:
    return ctypes.byref(ctypes.c_int32(value))


def _upper(matrix: csr_matrix, to: type) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Entries, columns and starts of rows of the upper triangle, columns rising."""
    if not matrix.has_sorted_indices:
        matrix = matrix.sorted_indices()
    n = matrix.shape[0]
    rows = np.repeat(np.arange(n, dtype=np.int32), np.diff(matrix.indptr))
    upper = matrix.indices >= rows
    starts = np.concatenate([[0], np.cumsum(np.bincount(rows[upper], minlength=n))])
    columns = matrix.indices[upper].astype(np.int32)
    return matrix.data[upper].astype(to), columns, starts.astype(np.int32)


@contextmanager
def factorised(matrix: csr_matrix, single: bool = False) -> Iterator[Back]:
    """K⁻¹ as a function of the right-hand side (N,), for as long as the context lasts.

    `single`: in single precision, where MKL is and that finds K positive definite.

    Raises
    ------
    SolveError : K is not positive definite, or the factors do not fit the memory.
    """
    if pardiso() is None:
        yield _superlu(matrix)
        return
    try:
        factors = PardisoFactors(matrix, single)
    except SolveError:
        if not single:
            raise
        factors = PardisoFactors(matrix, single=False)
    try:
        yield factors.solve
    finally:
        factors.release()


def direct(matrix: csr_matrix, right: np.ndarray) -> np.ndarray:
    """Solve K u = f once.

    Large systems by conjugate gradients on factors in single precision; by factors in double where those
    fail, or are not near enough to K⁻¹.

    Raises
    ------
    SolveError : as `factorised`.
    """
    if pardiso() is not None and matrix.shape[0] >= SINGLE_FROM and right.any():
        with factorised(matrix, single=True) as back, suppress(SolveError):
            return _in_double(matrix, right, back)
    with factorised(matrix) as back:
        return back(right)


def _in_double(matrix: csr_matrix, right: np.ndarray, back: Back) -> np.ndarray:
    """K⁻¹ f by conjugate gradients that `back`, factors in single precision, precondition.

    Raises
    ------
    SolveError : those are not near enough to K⁻¹, or FACTORED_STEPS are not enough.
    """
    x = np.zeros_like(right)
    for _ in range(FACTORED_ROUNDS):
        before = x

        def allowed(more: np.ndarray, before: np.ndarray = before) -> float:
            return FACTORED_ENERGY * abs(dot(before + more, right))

        off = right - matrix @ before
        found = conjugate_gradients(matrix.__matmul__, back, off, FACTORED_STEPS, allowed)
        if found.early:
            raise SolveError(f"{FACTORED_STEPS} steps were not enough")
        x = before + found.x
    return x


def _said(error: int, unknowns: int) -> SolveError:
    if error == PARDISO_OUT_OF_MEMORY:
        return SolveError(
            f"the direct solver has no memory for {unknowns} unknowns:"
            " raise solver.tolerance_pct or solver.edge_length_mm"
        )
    return SolveError(
        f"the direct solver stopped (Pardiso's error {error}): part of the model may be unsupported"
    )


def _superlu(matrix: csr_matrix) -> Back:
    from scipy.sparse.linalg import splu

    options = {"SymmetricMode": True}
    try:
        return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options=options).solve
    except RuntimeError as fault:  # its word for an exactly singular matrix
        raise SolveError(f"{fault}: part of the model may be unsupported") from fault


@cache
def pardiso() -> Any:
    """MKL's routine of that name, or None where MKL does not exist."""
    library = mkl()
    if library is None:
        return None
    routine = library["pardiso"]
    routine.restype = None
    return routine
