"""Patch edges on smooth surfaces, put into a mesher's mesh: it keeps corners, but no line on a plane.

Where mesh edges cross a patch edge, near ends move onto it and the other edges are halved there with all
their tetrahedra, after the warping and cutting of Labelle and Shewchuk, Isosurface stuffing, ACM
Transactions on Graphics 26 (2007) 57.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fea.solid.snap import undo_inverted
from fea.solid.unroll import Space
from geometry.outline import SAME, Segment, distance
from geometry.surfaces import Surface, Swept

SMOOTH = 1e-6
"""Segments whose tangents differ by less join smoothly."""
NEAR = 0.3
"""An end nearer to the patch edge than this share of a crossing mesh edge moves onto it."""


@dataclass(frozen=True)
class PatchEdge:
    """A circle about the axis where two surfaces that join smoothly have different patches.

    `r`, `z` [mm] and the meridian's tangent there; `first`, `second`: the surfaces before and after.
    """

    first: int
    second: int
    rz: np.ndarray
    tangent: np.ndarray

    def beyond(self, points: np.ndarray) -> np.ndarray:
        """How far (n,) [mm] points (n, 3) are beyond it, along the meridian."""
        return (_meridional(points) - self.rz) @ self.tangent

    def reached(self, points: np.ndarray) -> np.ndarray:
        """The points (n, 3) moved along the meridian until they are neither beyond nor before it."""
        rz = _meridional(points)
        moved = rz - self.beyond(points)[:, None] * self.tangent
        scale = moved[:, 0] / np.maximum(rz[:, 0], 1e-300)
        return np.column_stack([points[:, :2] * scale[:, None], moved[:, 1]])


def smooth_patch_edges(surfaces: Sequence[Surface]) -> Iterator[PatchEdge]:
    """Those between the swept surfaces of a part."""
    swept = [(i, s.segment) for i, s in enumerate(surfaces) if isinstance(s, Swept)]
    for i, a in swept:
        for j, b in swept:
            if distance(a.end, b.start) < SAME and a.patch != b.patch and _smooth(a, b):
                yield PatchEdge(i, j, np.array(b.start), b.tangent(0))


def with_patch_edges(
    points: np.ndarray,
    tets: np.ndarray,
    faces: np.ndarray,
    facet_surface: np.ndarray,
    surfaces: Sequence[Surface],
    space: Space,
) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) mm and tets (m, 4) in which no boundary edge crosses a patch edge.

    The points are in meshing space; `faces` (k, 3) is the boundary, `facet_surface` (k,) the surface of each.
    """
    for edge in smooth_patch_edges(surfaces):
        sides = _sides(faces[np.isin(facet_surface, (edge.first, edge.second))])
        beyond = edge.beyond(space.back(points))
        beyond[np.abs(beyond) < SAME] = 0.0
        crossing = sides[beyond[sides].prod(axis=1) < 0]
        share = np.abs(beyond[crossing]) / np.abs(np.diff(beyond[crossing]))
        near = np.unique(crossing[share < NEAR])
        wanted = points.copy()
        wanted[near] = space.to(edge.reached(space.back(points[near])))
        points = undo_inverted(points, wanted, tets)
        beyond[near[(points[near] == wanted[near]).all(axis=1)]] = 0.0
        for a, b in crossing[beyond[crossing].prod(axis=1) < 0]:
            at = beyond[a] / (beyond[a] - beyond[b])
            between = (points[a] + at * (points[b] - points[a]))[None]
            tets = _halved(tets, a, b, len(points))
            points = np.vstack([points, space.to(edge.reached(space.back(between)))])
    return points, tets


def _meridional(points: np.ndarray) -> np.ndarray:
    return np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])


def _smooth(a: Segment, b: Segment) -> bool:
    return bool(a.tangent(1) @ b.tangent(0) > 1 - SMOOTH)


def _sides(faces: np.ndarray) -> np.ndarray:
    """Edges (e, 2) of triangles (k, 3), each once."""
    return np.unique(np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)


def _halved(tets: np.ndarray, a: int, b: int, middle: int) -> np.ndarray:
    """Every tetrahedron with the edge from a to b as two, with the node `middle` between."""
    both = (tets == a).any(axis=1) & (tets == b).any(axis=1)
    one, other = tets[both], tets[both]
    one[one == b], other[other == a] = middle, middle
    return np.vstack([tets[~both], one, other])
