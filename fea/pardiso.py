"""oneMKL Pardiso's factors of a sparse symmetric positive definite matrix."""

from __future__ import annotations

import ctypes
from functools import cache
from typing import Any
from weakref import finalize

import numpy as np
from scipy.sparse import csr_matrix

from flexspline.fea.errors import SolveError
from flexspline.fea.kept_entries import KeptEntries, starts_of
from flexspline.fea.mkl import address, mkl

PARDISO_OUT_OF_MEMORY = -2
"""oneMKL's code for "not enough memory"."""
SYMMETRIC_POSITIVE = 2
"""oneMKL's matrix type: its upper triangle is given."""
ANALYSE_AND_FACTORISE, FACTORISE, SUBSTITUTE, RELEASE = 12, 22, 33, -1
"""oneMKL's phases."""
SETTINGS = {0: 1, 1: 2, 7: 0, 9: 8, 20: 1, 23: 1, 34: 1}
"""iparm by its number from 0; not oneMKL's defaults: factors by its two-level method (23), 0.7 to 1.05 of
the seconds of factors, and numbers from 0 (34)."""
ONE_THREAD_SETTINGS = SETTINGS | {1: 0, 23: 0}
"""Ordered by minimum degree (1), factors by the classic method (23). First harmonic of a cup, one core:
2 200, 5 800, 17 000, 48 000, 148 000 unknowns 3.7, 10.2, 36, 129, 602 ms; by SETTINGS 4.5, 15.4, 56, 253,
805. For one thread only: with two in each of two processes on two cores, `stiffness` of `xb1-40` takes 11 s
in place of 2.2."""
SMALL_SOLID = 50_000
"""Unknowns of a solid mesh up to which one thread does as well: 5 200, 11 000, 20 300, 49 100 take 24, 54,
139, 434 ms, by SETTINGS and two threads 22, 54, 150, 494. Beside a process that does the same the first three
take 25, 55, 140 and 32, 91, 204 ms. 95 800 take 1.7 s alone, with two threads 1.3."""
IN_SINGLE = 27
"""iparm: factors, matrix and right-hand sides of four bytes."""


class PardisoFactors:
    """Pardiso's factors of a matrix, until they are released or nobody holds this object.

    They are used with as many threads as they were made with, whoever calls: each thread has a number of its
    own, and factors of two threads substituted by one, or of one by two, give another vector without an error
    (‖Ku − f‖ of 2 to 9 ‖f‖ in 79 of 80 solves). Those of a `plane` mesh, or with at most SMALL_SOLID
    unknowns, are made by one thread and ONE_THREAD_SETTINGS.
    """

    def __init__(self, matrix: csr_matrix, single: bool, plane: bool = False) -> None:
        one_thread = plane or matrix.shape[0] <= SMALL_SOLID
        self._threads = 1 if one_thread else _threads_of_caller()
        self._pt = np.zeros(64, np.int64)
        self._iparm = np.zeros(64, np.int32)
        for number, value in (ONE_THREAD_SETTINGS if one_thread else SETTINGS).items():
            self._iparm[number] = value
        self._iparm[IN_SINGLE] = single
        self._type = np.float32 if single else np.float64
        matrix = _rising(matrix)
        self._upper = KeptEntries.of(matrix, _upper)
        self._starts = starts_of(self._upper.counts)
        self._columns = self._upper.columns.astype(np.int32)
        self._data = self._entries(matrix)
        self.release = finalize(
            self, _call, self._pt, self._iparm, self._threads, RELEASE, matrix.shape[0]
        )
        try:
            self._do(ANALYSE_AND_FACTORISE)
        except SolveError:
            self.release()
            raise

    def replace(self, matrix: csr_matrix) -> bool:
        """Factorise another matrix in place of this one, by the same ordering.

        False, and nothing is done, where its entries lie elsewhere.

        Raises
        ------
        SolveError : as when made; nothing can be solved any more.
        """
        matrix = _rising(matrix)
        if not self._upper.places.are_of(matrix):
            return False
        self._data = self._entries(matrix)
        self._do(FACTORISE)
        return True

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Return K⁻¹ f (N,) or (N, k), in double precision whatever the factors are."""
        b = np.asfortranarray(right, self._type)
        x = np.zeros_like(b)
        self._do(SUBSTITUTE, b, x)
        return x.astype(np.float64)

    def _do(self, phase: int, b: np.ndarray | None = None, x: np.ndarray | None = None) -> None:
        matrix = (self._data, self._starts, self._columns)
        _call(self._pt, self._iparm, self._threads, phase, len(self._starts) - 1, matrix, b, x)

    def _entries(self, matrix: csr_matrix) -> np.ndarray:
        return matrix.data[self._upper.kept].astype(self._type)


def _call(
    pt: np.ndarray,
    iparm: np.ndarray,
    threads: int,
    phase: int,
    unknowns: int,
    matrix: tuple[np.ndarray, ...] = (),
    b: np.ndarray | None = None,
    x: np.ndarray | None = None,
) -> None:
    columns = 1 if b is None or b.ndim == 1 else b.shape[1]
    one, silent, error = _pointer(1), _pointer(0), ctypes.c_int32(0)
    data, starts, places = map(address, matrix) if matrix else (None,) * 3
    right, solution = (None if v is None else address(v) for v in (b, x))
    of_caller = _set_threads(threads)
    pardiso()(
        address(pt), one, one, _pointer(SYMMETRIC_POSITIVE), _pointer(phase), _pointer(unknowns),
        data, starts, places, None, _pointer(columns), address(iparm), silent,
        right, solution, ctypes.byref(error),
    )  # fmt: skip
    _set_threads(of_caller)
    if error.value:
        raise _said(error.value, unknowns)


def _threads_of_caller() -> int:
    """How many threads oneMKL would use for the thread that calls."""
    return int(mkl().MKL_Get_Max_Threads())


def _set_threads(count: int) -> int:
    """Let oneMKL use so many for the thread that calls, 0: as usual; what was set before."""
    return int(mkl().MKL_Set_Num_Threads_Local(count))


def _pointer(value: int) -> Any:
    return ctypes.byref(ctypes.c_int32(value))


def _rising(matrix: csr_matrix) -> csr_matrix:
    """The matrix with rising columns in each row."""
    return matrix if matrix.has_sorted_indices else matrix.sorted_indices()


def _upper(rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """A mask of the entries that oneMKL takes: those of the upper triangle."""
    return columns >= rows


def _said(error: int, unknowns: int) -> SolveError:
    if error == PARDISO_OUT_OF_MEMORY:
        return SolveError(
            f"the direct solver has no memory for {unknowns} unknowns:"
            " raise solver.tolerance_pct or solver.edge_length_mm"
        )
    return SolveError(
        f"the direct solver stopped (Pardiso's error {error}): part of the model may be unsupported"
    )


@cache
def pardiso() -> Any:
    """Return MKL's routine of that name, or None where MKL does not exist."""
    library = mkl()
    if library is None:
        return None
    routine = library["pardiso"]
    routine.restype = None
    return routine
