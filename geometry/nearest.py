"""The CAD surface of a mesh facet: the nearest tagged triangle with a matching normal."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexspline.geometry.above_zero import ABOVE_ZERO

PAIRS_AT_ONCE = 4_000_000
"""Bounds the memory of the box test."""
FACING = 0.5
"""Least cosine between the normals of a facet and of the CAD triangle that it lies on: within 60°, so that
a facet at an edge is not taken for the face beside it."""


def nearest_triangles(
    points: np.ndarray,
    normals: np.ndarray,
    vertices: np.ndarray,
    triangles: np.ndarray,
    reach: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Index (k,) of the triangle nearest to each point, and whether its normal agrees (k,).

    `points` and unit `normals` are (k, 3), `vertices` (n, 3), `triangles` (m, 3). A triangle that
    faces more than 60° away counts only where there is no other. Points with no triangle within
    `reach` [mm] get index -1.
    """
    from trimesh.triangles import closest_point as closest

    closest_point: Callable[[np.ndarray, np.ndarray], np.ndarray] = closest

    corners = vertices[triangles]
    low, high = corners.min(axis=1) - reach, corners.max(axis=1) + reach
    facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing /= np.maximum(np.linalg.norm(facing, axis=1), ABOVE_ZERO)[:, None]
    step = max(1, PAIRS_AT_ONCE // len(triangles))
    nearest = np.full(len(points), -1)
    agrees = np.zeros(len(points), bool)
    for start in range(0, len(points), step):
        p = points[start : start + step]
        inside = np.ones((len(p), len(triangles)), bool)
        for axis in range(3):
            inside &= (p[:, axis, None] >= low[:, axis]) & (p[:, axis, None] <= high[:, axis])
        i, t = np.nonzero(inside)
        distance = np.linalg.norm(closest_point(corners[t], p[i]) - p[i], axis=1)
        agree = np.einsum("ij,ij->i", normals[start + i], facing[t])
        # along shared edges distances are equal: the better normal decides
        score = distance + 1e-6 * (1 - agree) + np.where(agree > FACING, 0.0, 1e3 * reach)
        order = np.lexsort((score, i))
        rows, first = np.unique(i[order], return_index=True)
        nearest[start + rows] = t[order][first]
        agrees[start + rows] = agree[order][first] > FACING
    return nearest, agrees
