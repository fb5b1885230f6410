"""From the tetrahedra of a sector to quadratic ones: boundary faces, middle nodes, curved edges."""

from __future__ import annotations

import numpy as np

from flexspline.fea.errors import MeshQualityError
from flexspline.fea.solid.elements import jacobian_ratio, linear_mesh

JACOBIAN_RATIO = 0.3
"""Least ratio of det J within an element; 0.2 is where meshers' quality checks warn. Seen: one element
in ten thousand below it, with ten times the true stress at its nodes."""
CORNER_FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
"""Outward faces of a positively oriented tetrahedron; face i is opposite corner i."""


def boundary_faces(tets: np.ndarray) -> np.ndarray:
    """Faces (k, 3) that belong to one tetrahedron only, outward."""
    faces = tets[:, CORNER_FACES].reshape(-1, 3)
    _, first, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    return faces[first[count == 1]]


def with_middles(
    corners: np.ndarray, tets: np.ndarray, faces: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges (e, 2), ten-node cells and six-node facets; middle node of edge i is len(corners) + i."""
    mesh = linear_mesh(corners, tets)
    edges = mesh.edges.T
    n = len(corners)
    cells = np.hstack([tets, mesh.t2e.T + n])
    key = edges[:, 0].astype(np.int64) * n + edges[:, 1]
    order = np.argsort(key)
    sides = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]], axis=2).astype(np.int64)
    found = order[np.searchsorted(key[order], sides[:, :, 0] * n + sides[:, :, 1])]
    return edges, cells, np.hstack([faces, found + n])


def straightened(nodes: np.ndarray, cells: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Straighten the edges of elements that curving has bent too far: their stresses are wrong."""
    n = len(nodes) - len(edges)
    out = nodes.copy()
    for _ in range(10):
        bad = jacobian_ratio(out, cells) < JACOBIAN_RATIO
        if not bad.any():
            return out
        middles = np.unique(cells[bad, 4:])
        out[middles] = out[edges[middles - n]].mean(axis=1)
    raise MeshQualityError(f"{int(bad.sum())} elements are badly bent even with straight edges")
