"""Entries of sparse matrices with the same pattern: where they stand is found once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix


@dataclass(frozen=True)
class EntryPlaces:
    """The places of a CSR matrix's entries: where each row starts, and the columns."""

    starts: np.ndarray
    columns: np.ndarray

    @classmethod
    def of(cls, matrix: csr_matrix) -> EntryPlaces:
        return cls(matrix.indptr, matrix.indices)

    def are_of(self, matrix: csr_matrix) -> bool:
        """Whether a matrix has its entries at the same places."""
        return np.array_equal(matrix.indptr, self.starts) and np.array_equal(
            matrix.indices, self.columns
        )


@dataclass(frozen=True)
class KeptEntries:
    """Which entries of a CSR matrix are kept.

    Attributes
    ----------
    places : of all its entries. kept : a mask of them.
    counts : (N,) of kept entries by row. columns : of these entries.
    """

    places: EntryPlaces
    kept: np.ndarray
    counts: np.ndarray
    columns: np.ndarray

    @classmethod
    def of(
        cls, matrix: csr_matrix, keep: Callable[[np.ndarray, np.ndarray], np.ndarray]
    ) -> KeptEntries:
        """Select entries by `keep`, which returns a mask from their rows and columns."""
        n = matrix.shape[0]
        rows = np.repeat(np.arange(n, dtype=np.int32), np.diff(matrix.indptr))
        kept = keep(rows, matrix.indices)
        counts = np.bincount(rows[kept], minlength=n)
        return cls(EntryPlaces.of(matrix), kept, counts, matrix.indices[kept])


def starts_of(counts: np.ndarray) -> np.ndarray:
    """Return (n + 1,) where each row starts, from the number of entries of each row (n,)."""
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
