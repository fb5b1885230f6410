"""Boundary edges of a tetrahedral mesh at which two surfaces of a part meet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos

import numpy as np
from scipy.spatial import cKDTree

from flexspline.fea.edges import SIDES, edge_numbers
from flexspline.geometry.outline import SAME_mm, Segment, SMOOTH_rad, joins_smoothly
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START, Plane, Surface, Swept

INSIDE_CORNER = 0.1
"""A corner is an inside corner if a facet rises over its neighbour's plane by an angle with at least this
sine. Judgement: 6°, far above rounding and below the corners of parts."""
ALONG = 5
"""Points along an edge where stress is singular, from which distances are measured."""


@dataclass(frozen=True)
class Seams:
    """Edges (e, 2) of mesh nodes between two surfaces (e, 2), none of them a plane of symmetry.

    Attributes
    ----------
    sharp : mask (e,), where the surfaces meet at an angle or the patch changes.
    singular : mask (e,), where torsional stress is singular: inside corners and edges of patches.
    revolved : mask (e,), circles about the axis.
    """

    nodes: np.ndarray
    surfaces: np.ndarray
    sharp: np.ndarray
    singular: np.ndarray
    revolved: np.ndarray


def seams_of(
    points: np.ndarray, facets: np.ndarray, facet_surface: np.ndarray, surfaces: Sequence[Surface]
) -> Seams:
    """Return a closed boundary's seams: facets (k, 3), outward, of points (n, 3) [mm], on surfaces (k,)."""
    sides = facets[:, SIDES].reshape(-1, 2)
    order = np.argsort(edge_numbers(sides, len(points)), kind="stable")
    one, other = order[0::2], order[1::2]
    on = np.column_stack([facet_surface[one // 3], facet_surface[other // 3]])
    mirror = np.array([s.patch in (SYMMETRY_START, SYMMETRY_END) for s in surfaces])
    kept = (on[:, 0] != on[:, 1]) & ~mirror[on].any(axis=1)
    one, other, on = one[kept], other[kept], on[kept]
    smooth, patches, revolved = _pairs(surfaces)
    changes = patches[on[:, 0], on[:, 1]]
    corner = points[facets[one // 3]]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    tip = points[facets[other // 3, (other % 3 + 2) % 3]] - corner[:, 0]
    rise = (normal * tip).sum(axis=1)
    size = np.linalg.norm(normal, axis=1) * np.linalg.norm(tip, axis=1)
    bent = ~smooth[on[:, 0], on[:, 1]]
    return Seams(
        sides[one], on, bent | changes, changes | (bent & (rise > INSIDE_CORNER * size)),
        revolved[on[:, 0], on[:, 1]],
    )  # fmt: skip


def _pairs(surfaces: Sequence[Surface]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of each two surfaces: whether they join smoothly, have different patches, are both revolved."""
    n = len(surfaces)
    smooth, patches, revolved = (np.zeros((n, n), bool) for _ in range(3))
    for i, a in enumerate(surfaces):
        for j, b in enumerate(surfaces):
            patches[i, j] = a.patch != b.patch
            if isinstance(a, Swept) and isinstance(b, Swept):
                revolved[i, j] = True
                if joins_smoothly(a.segment, b.segment):
                    smooth[i, j] = smooth[j, i] = True
            elif isinstance(a, Swept) and isinstance(b, Plane):
                smooth[i, j] = smooth[j, i] = _lies_in(a.segment, b)
    return smooth, patches, revolved


def _lies_in(segment: Segment, plane: Plane) -> bool:
    """Whether a surface of revolution ends as a part of a plane across the axis: a face at its height."""
    ends = ((segment.start, segment.tangent(0)), (segment.end, segment.tangent(1)))
    across = abs(plane.normal[2]) > cos(SMOOTH_rad)
    return across and any(
        abs(at[1] - plane.point[2]) < SAME_mm and abs(tangent[0]) > cos(SMOOTH_rad)
        for at, tangent in ends
    )


def distance_from(edges: np.ndarray, points: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the distance of places `at` (k, 3) from the nearest of edges (e, 2) [mm]; without any, inf."""
    if not len(edges):
        return np.full(len(at), np.inf)
    along = np.linspace(0, 1, ALONG)[None, :, None]
    a, b = points[edges[:, 0]][:, None], points[edges[:, 1]][:, None]
    return np.asarray(cKDTree((a + along * (b - a)).reshape(-1, 3)).query(at)[0])
