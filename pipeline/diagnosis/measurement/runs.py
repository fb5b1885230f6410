"""Runs of consecutive rows with a common property."""

from __future__ import annotations

import numpy as np


def runs(chosen: np.ndarray) -> list[tuple[int, int]]:
    """First row of each run of True in a mask (n,), and the row after its last.

    >>> runs(np.array([True, True, False, True]))
    [(0, 2), (3, 4)]
    """
    edges = np.diff(np.r_[0, chosen.astype(int), 0])
    begins, ends = np.flatnonzero(edges == 1).tolist(), np.flatnonzero(edges == -1).tolist()
    return list(zip(begins, ends, strict=True))
