"""From the tetrahedra of a sector to quadratic ones: boundary faces, middle nodes, curved edges."""

from __future__ import annotations

import numpy as np

from flexspline.fea.edges import (
    CORNER_FACES,
    SIDES,
    TET_EDGES,
    edge_numbers,
    face_numbers,
    numbered_edges,
)
from flexspline.fea.errors import MeshQualityError
from flexspline.fea.solid.elements import jacobian_ratio

JACOBIAN_RATIO = 0.3
"""Least ratio of det J within an element; 0.2 is where meshers' quality checks warn. One element in ten
thousand below it showed ten times the true stress at its nodes."""


def boundary_faces(tets: np.ndarray) -> np.ndarray:
    """Return the faces (k, 3), outward, that belong to one tetrahedron only."""
    faces = tets[:, CORNER_FACES].reshape(-1, 3)
    numbers = face_numbers(faces, int(tets.max()) + 1)
    _, first, count = np.unique(numbers, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def with_middles(
    corners: np.ndarray, tets: np.ndarray, faces: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return edges (e, 2), ten-node cells and six-node facets; edge i has node len(corners) + i."""
    n = len(corners)
    edges, of_cells = numbered_edges(tets[:, TET_EDGES], n)
    of_faces = np.searchsorted(edge_numbers(edges, n), edge_numbers(faces[:, SIDES], n))
    return edges, np.hstack([tets, of_cells + n]), np.hstack([faces, of_faces + n])


def straightened(
    nodes: np.ndarray, cells: np.ndarray, edges: np.ndarray, facets: np.ndarray
) -> np.ndarray:
    """Straighten the edges of elements that curving has bent too far, because their stresses are wrong.

    Edges within the part are straightened first, so that most edges of its surface stay curved. Without that
    rule a keyed shaft had 400 straight edges on its surface, where 33 are enough, and its K was 0.4 % too
    small.

    Raises
    ------
    MeshQualityError : straight edges do not help.
    """
    return straightened_too(*straightened_inside(nodes, cells, edges, facets), cells, edges)


def straightened_inside(
    nodes: np.ndarray, cells: np.ndarray, edges: np.ndarray, facets: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Make the edges inside straight; return the nodes and the cells' `jacobian_ratio` (m,)."""
    inside = np.ones(len(nodes), bool)
    inside[facets.ravel()] = False
    return _straightened(nodes, jacobian_ratio(nodes, cells), cells, edges, inside)


def straightened_too(
    nodes: np.ndarray, ratio: np.ndarray, cells: np.ndarray, edges: np.ndarray
) -> np.ndarray:
    """Make the edges of the surface straight too, after `straightened_inside`.

    Raises
    ------
    MeshQualityError : as `straightened`.
    """
    every = np.ones(len(nodes), bool)
    nodes, ratio = _straightened(nodes, ratio, cells, edges, every)
    if ratio.min() < JACOBIAN_RATIO:
        raise MeshQualityError("elements are badly bent even with straight edges")
    return nodes


def _straightened(
    nodes: np.ndarray, ratio: np.ndarray, cells: np.ndarray, edges: np.ndarray, movable: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Nodes with the `movable` (n,) middle ones of cells that are bent too far on straight edges; `ratio`."""
    n = len(nodes) - len(edges)
    left, nodes, ratio = movable.copy(), nodes.copy(), ratio.copy()
    while len(bad := _middles_of_bent(cells, ratio, left)):
        nodes[bad] = nodes[edges[bad - n]].mean(axis=1)
        left[bad] = False
        changed = np.isin(cells[:, 4:], bad).any(axis=1)
        ratio[changed] = jacobian_ratio(nodes, cells[changed])
    return nodes, ratio


def _middles_of_bent(cells: np.ndarray, ratio: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Middle nodes of cells that are bent too far, those that are `left` (n,)."""
    bad = np.unique(cells[ratio < JACOBIAN_RATIO, 4:])
    return bad[left[bad]]
