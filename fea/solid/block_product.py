"""Products of a matrix of 3 × 3 blocks with vectors, many of them: by oneMKL's threads, or by scipy."""

from __future__ import annotations

import ctypes
from typing import Any
from weakref import finalize

import numpy as np
from scipy.sparse import bsr_matrix

from flexspline.fea.errors import SolveError
from flexspline.fea.mkl import address, mkl

AS_IT_IS, GENERAL, ROWS_FIRST = 10, 20, 101
"""oneMKL's words: not transposed; of no special form; blocks row by row."""
NUMBERS_FROM_0 = 0
"""oneMKL's SPARSE_INDEX_BASE_ZERO: rows and columns are counted from 0, as in scipy."""


class _Form(ctypes.Structure):
    """oneMKL's `matrix_descr`: the last two say nothing of a general matrix."""

    _fields_ = [("type", ctypes.c_int), ("fill", ctypes.c_int), ("diagonal", ctypes.c_int)]


class BlockProduct:
    """Computes `matrix @ x`; x (3n,) has the matrix's precision."""

    def __init__(self, matrix: bsr_matrix) -> None:
        self._matrix = matrix
        self._handle = ctypes.c_void_p()
        library = mkl()
        if library is None:
            return
        double = matrix.dtype == np.float64
        # oneMKL reads these three in place
        self._starts = matrix.indptr.astype(np.int32, copy=False)
        self._columns = matrix.indices.astype(np.int32, copy=False)
        self._data = np.ascontiguousarray(matrix.data)
        create = library.mkl_sparse_d_create_bsr if double else library.mkl_sparse_s_create_bsr
        rows, columns = (ctypes.c_int32(size // 3) for size in matrix.shape)
        failed = create(
            ctypes.byref(self._handle), NUMBERS_FROM_0, ROWS_FIRST, rows, columns, ctypes.c_int32(3),
            address(self._starts), address(self._starts[1:]), address(self._columns), address(self._data),
        )  # fmt: skip
        if failed:
            raise SolveError(
                f"oneMKL does not take a matrix of {matrix.shape[0]} unknowns ({failed})"
            )
        finalize(self, library.mkl_sparse_destroy, self._handle)
        self._number: Any = ctypes.c_double if double else ctypes.c_float
        self._times = library.mkl_sparse_d_mv if double else library.mkl_sparse_s_mv

    def __matmul__(self, x: np.ndarray) -> np.ndarray:
        if not self._handle:
            return self._matrix @ x
        x = np.ascontiguousarray(x, self._matrix.dtype)
        y = np.empty(self._matrix.shape[0], x.dtype)
        one, zero = self._number(1.0), self._number(0.0)
        if failed := self._times(
            AS_IT_IS, one, self._handle, _Form(GENERAL), address(x), zero, address(y)
        ):
            raise SolveError(f"oneMKL's product with a matrix failed ({failed})")
        return y
