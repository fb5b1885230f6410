"""SuperLU's factors of a sparse symmetric positive definite matrix: for small ones, and without MKL."""

from __future__ import annotations

from scipy.sparse import csc_matrix, csr_matrix
from scipy.sparse.linalg import SuperLU, splu

PLANE_PANEL, SOLID_PANEL = 1, 10
"""Columns that are factorised together. Meridians of 300 to 48 000 unknowns take 1.2 times as long with
SuperLU's 20. Solids of 5 200 to 20 300 take 0.06 to 0.28 s with either, one of 49 100 2.3 s with 1, 1.6 with
10."""


def superlu(matrix: csr_matrix, panel: int) -> SuperLU:
    """Return SuperLU's factors; it raises RuntimeError for an exactly singular matrix."""
    return splu(
        csc_matrix(matrix.T),  # the same matrix, and by columns already
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        panel_size=panel,
        options={"SymmetricMode": True},
    )
