"""Entries of sparse matrices with the same pattern: where they stand is found once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

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


@dataclass(frozen=True)
class NodePairs:
    """Pairs of nodes that share an element: the entries of a form's matrix, those too that happen to be 0.

    Attributes
    ----------
    number : (p,) row·n + column, rising.
    place : (k, k, m) to which of them each element's entry is added: trial function, test function,
        element, as in scikit-fem's element matrices.
    """

    number: np.ndarray
    place: np.ndarray

    @classmethod
    def of(cls, cells: np.ndarray, n: int) -> NodePairs:
        """Find the pairs of elements (m, k) on n nodes."""
        of = cells.T.astype(np.int64)  # n² of 46 341 nodes is beyond 32 bits
        return cls(*np.unique(of[None] * n + of[:, None], return_inverse=True))

    def summed(self, entries: np.ndarray, elements: Any = slice(None)) -> np.ndarray:
        """Sums (p,) of the entries that a form has on all or some elements, `form.elemental(basis).data`."""
        return np.bincount(self.place[..., elements].ravel(), entries, len(self.number))

    @cached_property
    def transposed(self) -> np.ndarray:
        """Return the places (p,) of the transposed matrix's entries."""
        places = np.empty(len(self.number), int)
        places[self.place] = self.place.swapaxes(0, 1)
        return places
