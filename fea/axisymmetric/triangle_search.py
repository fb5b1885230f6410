"""Finds the triangles of a mesh that hold given points."""

from __future__ import annotations

from typing import Any

import numpy as np

NEAREST = (8, 64)
"""Triangles with the nearest centres in which a point is searched first, then all triangles. Judgement."""
CANDIDATES = 1_000_000
"""Pairs of point and triangle at once: 100 MB."""
TOUCH = 1e-9
"""How far, in shares of its height, a point may lie beyond its triangle's side: rounding."""


def triangles_of(mesh: Any, points: np.ndarray) -> np.ndarray:
    """Return the triangle (k,) of scikit-fem's mesh that holds each point (2, k); −1: none.

    Its own finder raises an error if one point is in none, and looks at all triangles for all points where
    five are not enough for one of them: 2.6 s and 2.5 GB for 9 000 points in 9 000 triangles, 0.1 s here.
    """
    from scipy.spatial import cKDTree

    corner = mesh.p[:, mesh.t]
    tree = cKDTree(corner.mean(axis=1).T)
    triangle, left = np.full(points.shape[1], -1), np.arange(points.shape[1])
    for count in (*NEAREST, mesh.nelements):
        for mine in np.array_split(left, 1 + len(left) * count // CANDIDATES):
            _, near = tree.query(points[:, mine].T, min(count, mesh.nelements))
            near = near.reshape(len(mine), -1)
            first, second = (corner[:, i, near] - corner[:, 0, near] for i in (1, 2))
            offset = points[:, mine, None] - corner[:, 0, near]
            area = first[0] * second[1] - first[1] * second[0]
            x = (offset[0] * second[1] - offset[1] * second[0]) / area
            y = (first[0] * offset[1] - first[1] * offset[0]) / area
            inside = np.minimum(np.minimum(x, y), 1 - x - y)
            best = inside.argmax(axis=1)[:, None]
            within = np.take_along_axis(inside, best, 1)[:, 0] > -TOUCH
            triangle[mine[within]] = np.take_along_axis(near, best, 1)[within, 0]
        left = np.flatnonzero(triangle < 0)
        if not len(left):
            break
    return triangle
