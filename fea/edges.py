"""Edges of triangles and tetrahedra by the numbers of their two nodes."""

from __future__ import annotations

import numpy as np

SIDES = np.array([[0, 1], [1, 2], [2, 0]])
"""Edges of a triangle."""


def edge_numbers(pairs: np.ndarray, nodes: int) -> np.ndarray:
    """Return one number for each edge (..., 2), whichever end comes first; `nodes` is the number of nodes."""
    a, b = pairs[..., 0].astype(np.int64), pairs[..., 1]
    return np.asarray(np.minimum(a, b) * nodes + np.maximum(a, b))


def distinct_edges(pairs: np.ndarray, nodes: int) -> np.ndarray:
    """Return each of the edges (..., 2) once, as (e, 2) with the lesser node first."""
    return np.column_stack(np.divmod(np.unique(edge_numbers(pairs, nodes)), nodes))
