"""Flatness of a mesh's elements: node-by-node smoothing converges slowly in flat elements."""

from __future__ import annotations

import numpy as np

from flexspline.fea.edges import CORNER_FACES
from flexspline.fea.solid.tetwild import signed_volumes
from flexspline.fea.types import TetMesh

FLAT_ASPECT, FLAT_ELEMENTS_SHARE = 150.0, 0.1
"""Longest edge over thickness of a flat element, and the share of flat elements that makes an iteration slow.
In meshes of shafts the flattest tenth of the elements had ratios of 4 to 55 (10 to 68 steps), 70 to 103 (100
steps) and 255 to 418 (246 to 334 steps)."""


def mostly_flat(mesh: TetMesh) -> bool:
    """Whether an iteration on the mesh is expected to take longer than factors."""
    return bool(np.mean(aspects(mesh) > FLAT_ASPECT) > FLAT_ELEMENTS_SHARE)


def aspects(mesh: TetMesh) -> np.ndarray:
    """Return longest edge over thickness (m,) of the straight tetrahedra; a regular one has 1.22."""
    tets = mesh.cells[:, :4]
    corner = mesh.nodes[tets]
    sides = [(corner[:, b] - corner[:, a], corner[:, c] - corner[:, a]) for a, b, c in CORNER_FACES]
    largest = np.max([np.linalg.norm(np.cross(*two), axis=1) / 2 for two in sides], axis=0)
    return longest_edges(mesh.nodes, tets) * largest / (3 * signed_volumes(mesh.nodes, tets))


def longest_edges(points: np.ndarray, tets: np.ndarray) -> np.ndarray:
    """Return the longest edges (t,) mm of straight tetrahedra (t, 4)."""
    corner = points[tets]
    sides = [corner - np.roll(corner, k, axis=1) for k in (1, 2)]
    return np.linalg.norm(sides, axis=3).max(axis=(0, 2))
