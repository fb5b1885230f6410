"""A triangulated sector of a plan in which every line of it is made of mesh edges.

Delaunay's in the coordinates (ln r, φ): a conformal map, in which rings about the axis are straight and
a sector is a rectangle. Lines are halved until no vertex lies within an edge's diametral circle (Ruppert,
J. Algorithms 18, 1995, 548-585); poor triangles are improved only while they are large.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from flexspline.fea.axisymmetric.meridian_mesh import MeshingError, edge_lengths, signed_areas
from flexspline.fea.solid.plan_curves import Curve
from flexspline.fea.solid.plan_edges import PlanEdges, keys
from flexspline.geometry.above_zero import ABOVE_ZERO

SMALLEST_ANGLE = np.radians(20)
"""Of large triangles: what Ruppert's proof covers."""
FLATTENED = 0.3
"""Of a triangle's area in the map: one that keeps less with straight sides lies along too long an arc."""
OFF_LINE = 0.12
"""Of a triangle's height over an edge of a line: how far the line's middle may lie off the edge's, into it. A
middle node moved by 1/4 of the height makes the Jacobian 0 at the edge's ends."""
TOUCH = 1e-7
"""Relative slack of circle tests: rectangles' corners lie on one circle."""
ROUNDS = 60
"""Plans of 150 random shafts took 30 at most."""
MOST_POINTS = 4_000
"""A plan is repeated for each layer: more, and lines lie too near each other."""


@dataclass(frozen=True)
class PlanMesh:
    """Points (n, 2) as (r, φ) and triangles (m, 3), counter-clockwise in (r, φ)."""

    points: np.ndarray
    triangles: np.ndarray


def triangulated(curves: Sequence[Curve], sector: float, smallest_mm: float) -> PlanMesh:
    """The sector from angle 0 to `sector` [rad], between the least and the largest radius of its lines.

    Of `curves`, the bounds of the sector are some. Triangles whose sides are below `smallest_mm` may be poor.

    Raises
    ------
    MeshingError : lines too near each other, or that cross at too small an angle.
    """
    own = PlanEdges(curves, sector)
    largest = np.array([c.largest_share for c in curves])
    while (large := (np.diff(own.share, axis=1)[:, 0] > largest[own.owner] * (1 + TOUCH))).any():
        own.split(large)
    for _ in range(ROUNDS):
        if len(own.points) > MOST_POINTS:
            break
        length = own.lengths()
        middle = own.points[own.ends].mean(axis=1)
        nearest, _ = cKDTree(own.points).query(middle)
        crowded = nearest < length / 2 * (1 - TOUCH)
        if crowded.any():
            own.split(crowded)
            continue
        triangles = _delaunay(own.points)
        added, halve = _flattened(own, triangles)
        if not len(added) and not halve.any():
            added, halve = _improvements(own, triangles, smallest_mm)
        if not len(added) and not halve.any():
            return _checked(own, triangles)
        own.points = np.vstack([own.points, added])
        own.split(halve)
    raise MeshingError(f"the plan cannot be meshed: still uneven with {len(own.points)} points")


def _delaunay(points: np.ndarray) -> np.ndarray:
    triangles = Delaunay(points).simplices.astype(np.int64)
    area = signed_areas(points, triangles)
    triangles[area < 0] = triangles[area < 0][:, ::-1]
    longest = edge_lengths(points, triangles).max(axis=1)
    return triangles[np.abs(area) > 1e-9 * longest**2]  # less is a line, by rounding on the hull


def _improvements(
    own: PlanEdges, triangles: np.ndarray, smallest_mm: float
) -> tuple[np.ndarray, np.ndarray]:
    """Circumcentres (j, 2) worth adding, and the mask of edges to halve instead."""
    none = np.zeros(len(own.ends), bool)
    corner = own.points[triangles]
    sides = edge_lengths(own.points, triangles)
    radius = sides.prod(axis=1) / (
        4 * np.maximum(np.abs(signed_areas(own.points, triangles)), ABOVE_ZERO)
    )
    scale = np.exp(corner[:, :, 0].mean(axis=1))
    bad = (radius > sides.min(axis=1) / (2 * np.sin(SMALLEST_ANGLE))) & (
        sides.min(axis=1) * scale > smallest_mm
    )
    if not bad.any():
        return np.empty((0, 2)), none
    order = np.argsort(-radius[bad])
    centre, reach = _circumcentres(corner[bad])[order], radius[bad][order]
    inside = ((centre > own.points.min(axis=0)) & (centre < own.points.max(axis=0))).all(axis=1)
    length, middle = own.lengths(), own.points[own.ends].mean(axis=1)
    entered = cKDTree(centre).query_ball_point(middle, length / 2 * (1 - TOUCH))
    free = inside.copy()
    free[np.array([i for found in entered for i in found], int)] = False
    halve = np.array([len(found) > 0 for found in entered])
    halve &= length * np.exp(middle[:, 0]) > 2 * smallest_mm
    taken = np.zeros(len(centre), bool)
    near = cKDTree(centre).query_ball_point(centre, reach)
    for i in np.flatnonzero(free):
        taken[i] = not taken[near[i]].any()
    return centre[taken], halve


def _flattened(own: PlanEdges, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Middles (j, 2) of the longest sides of triangles that straight sides flatten, or the edges to halve.

    Edges are too that lie too far off their line for the triangles beside them.
    """
    u, phi = own.points.T
    n = len(own.points)
    straight = np.exp(u)[:, None] * np.column_stack([np.cos(phi), np.sin(phi)])
    scale = np.exp(u[triangles].mean(axis=1)) ** 2
    area = signed_areas(own.points, triangles)
    mine = triangles[signed_areas(straight, triangles) < FLATTENED * scale * area]
    longest = edge_lengths(own.points, mine).argmax(axis=1)
    rows = np.arange(len(mine))
    flat = keys(np.column_stack([mine[rows, longest], mine[rows, (longest + 1) % 3]]), n)
    lines = keys(own.ends, n)
    pairs = triangles[:, [[0, 1], [1, 2], [2, 0]]]
    off = own.middles() - own.points[own.ends].mean(axis=1)
    order = np.argsort(lines)
    at = order[np.minimum(np.searchsorted(lines[order], keys(pairs, n)), len(lines) - 1)]
    along = own.points[pairs[..., 1]] - own.points[pairs[..., 0]]
    inwards = along[..., 0] * off[at, 1] - along[..., 1] * off[at, 0]  # over the edge's length
    near = (lines[at] == keys(pairs, n)) & (inwards > OFF_LINE * 2 * area[:, None])
    free = np.setdiff1d(flat, lines)
    added = (own.points[free // n] + own.points[free % n]) / 2
    return added, np.isin(lines, np.union1d(flat, lines[at[near]]))


def _circumcentres(corner: np.ndarray) -> np.ndarray:
    u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    uu, vv = (u * u).sum(axis=1), (v * v).sum(axis=1)
    twice = 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    off = np.column_stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu])
    return np.asarray(corner[:, 0] + off / twice[:, None])


def _checked(own: PlanEdges, triangles: np.ndarray) -> PlanMesh:
    """Refuse a plan that lacks an edge of a line, or does not fill its rectangle."""
    n = len(own.points)
    sides = triangles[:, [[0, 1], [1, 2], [2, 0]]]
    missing = ~np.isin(keys(own.ends, n), keys(sides, n))
    span = np.ptp(own.points, axis=0).prod()
    covered = signed_areas(own.points, triangles).sum()
    if missing.any() or not abs(covered / span - 1) < 1e-9:  # rounding of a few thousand areas
        raise MeshingError(f"the plan lacks {int(missing.sum())} edges of its lines")
    return PlanMesh(np.column_stack([np.exp(own.points[:, 0]), own.points[:, 1]]), triangles)
