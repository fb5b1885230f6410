"""Steps of Delaunay refinement (Ruppert, J. Algorithms 18, 1995, 548-585), shared by meridian and plan.

Points are (n, 2), triangles (m, 3) counter-clockwise, edges (k, 2) the point numbers of the lines that the
mesh must keep.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from flexspline.fea.axisymmetric.meridian_mesh import edge_lengths, signed_areas
from flexspline.geometry.above_zero import ABOVE_ZERO

FLAT_SHARE = 1e-9
"""A triangle with less area than this share of its longest side squared is a line. Rounding leaves such
triangles on the hull, between points of one straight segment, turned either way."""
TOUCH = 1e-7
"""Relative slack of circle tests: cocircular points of right angles and rectangles count as outside."""


def lengths(points: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return the lengths of the edges (k,)."""
    return np.asarray(np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1))


def is_flat(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the mask (m,) of triangles that are lines but for rounding, turned either way."""
    longest = edge_lengths(points, triangles).max(axis=1)
    return np.asarray(np.abs(signed_areas(points, triangles)) <= FLAT_SHARE * longest**2)


def encroached(points: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return the mask (k,) of edges with a point, not an end, inside their diametral circle."""
    nearest, _ = cKDTree(points).query(points[edges].mean(axis=1))
    return np.asarray(nearest < lengths(points, edges) / 2 * (1 - TOUCH))


def circumradii(sides: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """Return abc/(4A) (m,) of triangles with sides (m, 3) and areas (m,), above 0."""
    return np.asarray(sides.prod(axis=1) / (4 * np.maximum(areas, ABOVE_ZERO)))


def circumcentres(corner: np.ndarray) -> np.ndarray:
    """Return the circumcentres (m, 2) of triangles with corners (m, 3, 2)."""
    u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    uu, vv = (u * u).sum(axis=1), (v * v).sum(axis=1)
    twice = 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    offset = np.column_stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu])
    return np.asarray(corner[:, 0] + offset / twice[:, None])


def is_poor(sides: np.ndarray, radii: np.ndarray, smallest_angle: float) -> np.ndarray:
    """Return the mask (m,) of triangles with a smaller angle [rad]: the shortest side is 2R sin of it."""
    return np.asarray(radii > sides.min(axis=1) / (2 * np.sin(smallest_angle)))


def improvements(
    points: np.ndarray, edges: np.ndarray, poor: np.ndarray, radii: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return circumcentres (j, 2) to add for poor triangles (m, 3), and a mask of edges to halve."""
    if not len(poor):
        return np.empty((0, 2)), np.zeros(len(edges), bool)
    order = np.argsort(-radii)
    centre, reach = circumcentres(points[poor])[order], radii[order]
    within, halve = entering(points, edges, centre)
    # while no point is inside an edge's circle, no centre lies beyond the edges, but for rounding
    low, high = points.min(axis=0), points.max(axis=0)
    free = ((centre > low) & (centre < high)).all(axis=1) & ~within
    return independent(centre[free], reach[free]), halve


def entering(
    points: np.ndarray, edges: np.ndarray, centres: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return masks of centres (c,) inside the diametral circle of an edge, and of edges (k,) entered so."""
    half = lengths(points, edges) / 2 * (1 - TOUCH)
    of_edges = cKDTree(centres).query_ball_point(points[edges].mean(axis=1), half)
    within = np.zeros(len(centres), bool)
    within[np.array([i for inside in of_edges for i in inside], int)] = True
    return within, np.array([len(inside) > 0 for inside in of_edges])


def independent(centres: np.ndarray, reach: np.ndarray) -> np.ndarray:
    """Return those (j, 2) of the centres (c, 2), in order, not within `reach` (c,) of one before."""
    if not len(centres):
        return centres
    near = cKDTree(centres).query_ball_point(centres, reach)
    taken = np.zeros(len(centres), bool)
    for i, others in enumerate(near):
        taken[i] = not taken[others].any()
    return np.asarray(centres[taken])
