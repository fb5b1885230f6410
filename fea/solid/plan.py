"""A triangulated sector of a plan; every line of the plan consists of mesh edges.

Delaunay's in the coordinates (ln r, φ): a conformal map, in which rings about the axis are straight and
a sector is a rectangle. Lines are halved until no vertex lies within an edge's diametral circle
(`axisymmetric/ruppert.py`); poor triangles are improved only while they are large.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay

from flexspline.fea.axisymmetric.meridian_mesh import MeshingError, edge_lengths, signed_areas
from flexspline.fea.axisymmetric.ruppert import (
    TOUCH,
    circumradii,
    encroached,
    improvements,
    is_flat,
    is_poor,
)
from flexspline.fea.edges import SIDES, edge_numbers
from flexspline.fea.solid.plan_curves import Curve
from flexspline.fea.solid.plan_edges import PlanEdges

SMALLEST_PLAN_ANGLE = np.radians(20)
"""Smallest angle of large triangles: the limit of Ruppert's proof."""
FLATTENED_TRIANGLE = 0.3
"""Share of its area in the map that a triangle must keep with straight sides; if it keeps less, it lies along
too long an arc. Judgement."""
OFF_LINE = 0.12
"""How far the middle of a line may lie off the middle of its mesh edge, towards the triangle, as a share of
the triangle's height. Half of 1/4: a middle node moved by 1/4 of the height makes the Jacobian 0 at the
edge's ends."""
PLAN_ROUNDS = 60
"""Most rounds. Plans of 150 random shafts took 30 at most."""
PLAN_POINTS = 4_000
"""Most points of a plan, which is repeated for each layer. If it needs more, its lines lie too near each
other. Judgement."""


@dataclass(frozen=True)
class PlanMesh:
    """Points (n, 2) as (r, φ) and triangles (m, 3), counter-clockwise in (r, φ)."""

    points: np.ndarray
    triangles: np.ndarray


def triangulated(curves: Sequence[Curve], sector: float, smallest_mm: float) -> PlanMesh:
    """Triangulate the sector from angle 0 to `sector` [rad], between the lines' least and largest radius.

    The bounds of the sector are among `curves`. Triangles whose sides are below `smallest_mm` may be poor.

    Raises
    ------
    MeshingError : lines too near each other, or that cross at too small an angle.
    """
    edges = PlanEdges(curves, sector)
    largest = np.array([c.largest_share for c in curves])
    while (
        large := (np.diff(edges.share, axis=1)[:, 0] > largest[edges.owner] * (1 + TOUCH))
    ).any():
        edges.split(large)
    for _ in range(PLAN_ROUNDS):
        if len(edges.points) > PLAN_POINTS:
            break
        crowded = encroached(edges.points, edges.ends)
        if crowded.any():
            edges.split(crowded)
            continue
        triangles = _delaunay(edges.points)
        added, halve = _flattened(edges, triangles)
        if not len(added) and not halve.any():
            added, halve = _improvements(edges, triangles, smallest_mm)
        if not len(added) and not halve.any():
            return _checked(edges, triangles)
        edges.points = np.vstack([edges.points, added])
        edges.split(halve)
    raise MeshingError(f"the plan cannot be meshed: still uneven with {len(edges.points)} points")


def _delaunay(points: np.ndarray) -> np.ndarray:
    triangles = Delaunay(points).simplices.astype(np.int64)
    area = signed_areas(points, triangles)
    triangles[area < 0] = triangles[area < 0][:, ::-1]
    return triangles[~is_flat(points, triangles)]


def _improvements(
    edges: PlanEdges, triangles: np.ndarray, smallest_mm: float
) -> tuple[np.ndarray, np.ndarray]:
    """Circumcentres (j, 2) worth adding, and the mask of edges to halve instead."""
    sides = edge_lengths(edges.points, triangles)
    radius = circumradii(sides, signed_areas(edges.points, triangles))
    scale = np.exp(edges.points[triangles, 0].mean(axis=1))
    poor = is_poor(sides, radius, SMALLEST_PLAN_ANGLE) & (sides.min(axis=1) * scale > smallest_mm)
    added, halve = improvements(edges.points, edges.ends, triangles[poor], radius[poor])
    middle = edges.points[edges.ends].mean(axis=1)
    return added, halve & (edges.lengths() * np.exp(middle[:, 0]) > 2 * smallest_mm)


def _flattened(edges: PlanEdges, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Middles (j, 2) of the longest sides of triangles that straight sides flatten, or the edges to halve.

    Edges that lie too far off their line for the triangles beside them are halved too.
    """
    u, phi = edges.points.T
    n = len(edges.points)
    straight = np.exp(u)[:, None] * np.column_stack([np.cos(phi), np.sin(phi)])
    scale = np.exp(u[triangles].mean(axis=1)) ** 2
    area = signed_areas(edges.points, triangles)
    mine = triangles[signed_areas(straight, triangles) < FLATTENED_TRIANGLE * scale * area]
    longest = edge_lengths(edges.points, mine).argmax(axis=1)
    rows = np.arange(len(mine))
    flat = edge_numbers(np.column_stack([mine[rows, longest], mine[rows, (longest + 1) % 3]]), n)
    lines = edge_numbers(edges.ends, n)
    pairs = triangles[:, SIDES]
    off = edges.middles() - edges.points[edges.ends].mean(axis=1)
    order = np.argsort(lines)
    at = order[np.minimum(np.searchsorted(lines[order], edge_numbers(pairs, n)), len(lines) - 1)]
    along = edges.points[pairs[..., 1]] - edges.points[pairs[..., 0]]
    inwards = along[..., 0] * off[at, 1] - along[..., 1] * off[at, 0]  # over the edge's length
    near = (lines[at] == edge_numbers(pairs, n)) & (inwards > OFF_LINE * 2 * area[:, None])
    free = np.setdiff1d(flat, lines)
    added = (edges.points[free // n] + edges.points[free % n]) / 2
    return added, np.isin(lines, np.union1d(flat, lines[at[near]]))


def _checked(edges: PlanEdges, triangles: np.ndarray) -> PlanMesh:
    """Refuse a plan that lacks an edge of a line, or does not fill its rectangle."""
    n = len(edges.points)
    sides = triangles[:, SIDES]
    missing = ~np.isin(edge_numbers(edges.ends, n), edge_numbers(sides, n))
    span = np.ptp(edges.points, axis=0).prod()
    covered = signed_areas(edges.points, triangles).sum()
    if missing.any() or not abs(covered / span - 1) < 1e-9:  # rounding of a few thousand areas
        raise MeshingError(f"the plan lacks {int(missing.sum())} edges of its lines")
    return PlanMesh(np.column_stack([np.exp(edges.points[:, 0]), edges.points[:, 1]]), triangles)
