"""Edges and faces of triangles and tetrahedra; edges by the numbers of their two nodes."""

from __future__ import annotations

import numpy as np

SIDES = np.array([[0, 1], [1, 2], [2, 0]])
"""Edges of a triangle."""
TET_EDGES = np.array([[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]])
"""Edges of a tetrahedron, in the order of its middle nodes."""
CORNER_FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
"""Outward faces of a positively oriented tetrahedron; face i is opposite corner i."""


def edge_numbers(pairs: np.ndarray, nodes: int) -> np.ndarray:
    """Return one number for each edge (..., 2), whichever end comes first; `nodes` is the number of nodes."""
    a, b = pairs[..., 0].astype(np.int64), pairs[..., 1]
    return np.asarray(np.minimum(a, b) * nodes + np.maximum(a, b))


def face_numbers(corners: np.ndarray, nodes: int) -> np.ndarray:
    """Return one number for each face of corners (..., 3), whichever comes first, rising with its corners."""
    first, second, third = np.moveaxis(np.sort(corners, axis=-1).astype(np.int64), -1, 0)
    return np.asarray((first * nodes + second) * nodes + third)


def distinct_edges(pairs: np.ndarray, nodes: int) -> np.ndarray:
    """Return each of the edges (..., 2) once, as (e, 2) with the lesser node first."""
    return np.column_stack(np.divmod(np.unique(edge_numbers(pairs, nodes)), nodes))


def numbered_edges(pairs: np.ndarray, nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Return `distinct_edges` and the number (...) among them of each of the edges (..., 2).

    scikit-fem numbers the edges of a mesh in the same order.
    """
    numbers = edge_numbers(pairs, nodes)
    distinct, of = np.unique(numbers, return_inverse=True)
    return np.column_stack(np.divmod(distinct, nodes)), of.reshape(numbers.shape)
