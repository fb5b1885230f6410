"""First mesh of a meridian: Delaunay refinement after Ruppert (`ruppert.py`).

Boundary edges are halved until no vertex lies within their diametral circle, which makes each of
them an edge of the Delaunay triangulation; then circumcentres of poorly shaped triangles are
added, or the edges halved whose circle they would enter. Triangulations come from Qhull (scipy).
Element size follows the local thickness by itself: one layer across a thin wall.
"""

from __future__ import annotations

from functools import lru_cache
from math import ceil, pi

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay

from flexspline.fea.axisymmetric.meridian_mesh import (
    MeridianMesh,
    MeshingError,
    edge_middles,
    signed_areas,
)
from flexspline.fea.axisymmetric.ruppert import (
    circumradii,
    encroached,
    improvements,
    is_flat,
    is_poor,
    lengths,
)
from flexspline.geometry.outline import Meridian, SAME_mm, Segment

CHORD_ANGLE = pi / 12
"""Largest opening angle of a first chord: its sagitta, 1/30 of it, cannot fold a triangle."""
SMALLEST_ANGLE = pi / 180 * 24
"""Ruppert's proof covers 20.7°. In practice refinement ends up to 30°, and P2 gains little beyond 24°."""
OUTLINE_ROUNDS = 300
"""Most rounds. 158 outlines of random designs took 11 to 25. Endless refinement is mostly stopped by
OUTLINE_POINTS."""
OUTLINE_POINTS = 20_000
"""Most points. An outline without crossings needs a few hundred; one that crosses itself is refined without
end."""


@lru_cache(maxsize=8)  # both parts, the seat of half the width, and a few before them
def triangulate(outline: Meridian, inner: tuple[Segment, ...] = ()) -> MeridianMesh:
    """Mesh an outline whose corners are not much sharper than 60°. All load cases share it.

    `inner`: a line across the material, straight segments end to end between two vertices of the outline;
    it is made of edges of the mesh.

    Raises
    ------
    MeshingError
        If refinement does not end: the outline crosses itself or has needle corners.
    """
    lines = Meridian((*outline.segments, *inner))
    points, edges, segment = _first_edges(outline, inner)
    for _ in range(OUTLINE_ROUNDS):
        if len(points) > OUTLINE_POINTS:
            break
        crowded = encroached(points, edges)
        if not crowded.any():
            triangles = _inside(points, edges)
            added, crowded = _improvements(points, edges, triangles)
            if not len(added) and not crowded.any():
                on_outline = segment < len(outline.segments)
                return _checked(outline, points, triangles, edges[on_outline], segment[on_outline])
            points = np.concatenate([points, added])
        points, edges, segment = _halved(lines, points, edges, segment, crowded)
    raise MeshingError(
        f"the outline cannot be meshed: still uneven with {len(points)} points, shortest boundary "
        f"edge {lengths(points, edges).min():.3g} mm; it crosses itself or has needle corners"
    )


def _first_edges(
    outline: Meridian, inner: tuple[Segment, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    points, segment = [], []
    for i, s in enumerate(outline.segments):
        n = 1 if s.centre is None else max(2, ceil(abs(s.sweep) / CHORD_ANGLE))
        points.append(s.at(np.arange(n) / n))
        segment += [i] * n
    stacked = np.concatenate(points)
    start = np.arange(len(stacked))
    edges = np.column_stack([start, np.roll(start, -1)])
    for i, s in enumerate(inner, len(outline.segments)):
        stacked, ends = _with_ends(stacked, s)
        edges = np.vstack([edges, ends])
        segment.append(i)
    return stacked, edges, np.array(segment)


def _with_ends(points: np.ndarray, s: Segment) -> tuple[np.ndarray, list[int]]:
    """Points (n, 2) with a segment's ends among them, and the numbers of these."""
    ends = []
    for end in (s.start, s.end):
        away = np.hypot(*(points - np.array(end)).T)
        if away.min() > SAME_mm:
            points, away = np.vstack([points, end]), np.append(away, 0.0)
        ends.append(int(away.argmin()))
    return points, ends


def _halved(
    outline: Meridian,
    points: np.ndarray,
    edges: np.ndarray,
    segment: np.ndarray,
    mask: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    old, mine = edges[mask], segment[mask]
    new = len(points) + np.arange(len(old))
    points = np.concatenate([points, edge_middles(outline, points, old, mine)])
    first, second = np.column_stack([old[:, 0], new]), np.column_stack([new, old[:, 1]])
    return (
        points,
        np.concatenate([edges[~mask], first, second]),
        np.concatenate([segment[~mask], mine, mine]),
    )


def _inside(points: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Delaunay triangles (m, 3) on the outline's left, counter-clockwise.

    Boundary edges cut the triangulation into regions; a region lies inside if a triangle of it has
    a boundary edge running in the outline's direction. One that is flat has no such direction.
    """
    whole = Delaunay(points)
    triangles, across = whole.simplices.astype(np.int64), whole.neighbors
    area = signed_areas(points, triangles)
    flipped = area < 0
    triangles[flipped] = triangles[flipped][:, ::-1]
    across[flipped] = across[flipped][:, ::-1]
    n = len(points)
    side = triangles[:, [1, 2, 0]] * n + triangles[:, [2, 0, 1]]  # opposite each corner
    forward = np.isin(side, edges[:, 0] * n + edges[:, 1])
    backward = np.isin(side, edges[:, 1] * n + edges[:, 0])
    tri, corner = np.nonzero((across >= 0) & ~forward & ~backward)
    links = coo_matrix((np.ones(len(tri)), (tri, across[tri, corner])), shape=2 * (len(side),))
    _, region = connected_components(links, directed=False)
    inside = forward.any(axis=1) & ~is_flat(points, triangles)
    return triangles[np.isin(region, region[inside])]


def _improvements(
    points: np.ndarray, edges: np.ndarray, triangles: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Circumcentres (j, 2) worth adding, and the mask of edges to halve instead."""
    corner = points[triangles]
    sides = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2)
    radius = circumradii(sides, signed_areas(points, triangles))
    poor = is_poor(sides, radius, SMALLEST_ANGLE)
    return improvements(points, edges, triangles[poor], radius[poor])


def _checked(
    outline: Meridian,
    points: np.ndarray,
    triangles: np.ndarray,
    edges: np.ndarray,
    segment: np.ndarray,
) -> MeridianMesh:
    """Refuse a mesh that does not fill its polygon."""
    a, b = points[edges[:, 0]], points[edges[:, 1]]
    polygon = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2)
    meshed = float(signed_areas(points, triangles).sum())
    if not abs(meshed - polygon) < 1e-9 * polygon:  # rounding of sums of a few thousand areas
        raise MeshingError(f"triangles cover {meshed:.9g} mm² of an outline of {polygon:.9g} mm²")
    return MeridianMesh(outline, points, triangles, edges, segment)
