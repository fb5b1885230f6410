"""A triangle mesh of a meridian; each boundary edge has a reference to its segment of the outline."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.fea.types import shortest_edge_mm
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.outline import Meridian, SAME_mm


def edge_lengths(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the lengths (m, 3) from each corner to the next, of `points` (n, 2) and `triangles` (m, 3)."""
    corner = points[triangles]
    return np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2)


class MeshingError(ComputationError):
    """The meridian could not be meshed; the message carries the numbers."""


@dataclass(frozen=True)
class MeridianMesh:
    """Straight triangles; nodes of fillets lie on the exact arc.

    Attributes
    ----------
    outline : the meridian that is meshed.
    points : (n, 2) vertices (r, z) [mm].
    triangles : (m, 3) vertex indices, counter-clockwise.
    edges : (k, 2) boundary edges, directed as the outline (material on the left).
    edge_segment : (k,) index into ``outline.segments`` of each boundary edge.
    """

    outline: Meridian
    points: np.ndarray
    triangles: np.ndarray
    edges: np.ndarray
    edge_segment: np.ndarray

    def containing(self) -> np.ndarray:
        """Vertices (n, 2) moved so that the mesh covers the exact meridian and more."""
        return self._arcs_pushed(convex=True)

    def contained(self) -> np.ndarray:
        """Vertices (n, 2) moved so that the mesh lies within the exact meridian."""
        return self._arcs_pushed(convex=False)

    def _arcs_pushed(self, convex: bool) -> np.ndarray:
        """Arcs of one kind circumscribed by tangents; those of the other stay cut by chords.

        Chords of a convex arc (material within its circle) lie in the material, tangents outside;
        of a concave arc the other way round. An edge of opening angle a between two nodes at
        distance R/cos(a/2) from the centre clears the circle; where one of them is the arc's end,
        which stays at R, the other needs R/cos a.
        """
        moved = self.points.copy()
        for index, s in enumerate(self.outline.segments):
            if s.centre is None or (s.sweep > 0) != convex:
                continue
            edges = self.edges[self.edge_segment == index]
            nodes, place = np.unique(edges, return_inverse=True)
            place = place.reshape(edges.shape)
            inner = np.bincount(place.ravel()) == 2
            chord = np.linalg.norm(np.diff(self.points[edges], axis=1)[:, 0], axis=1)
            angle = 2 * np.arcsin(np.minimum(1.0, chord / (2 * s.radius)))
            needed = np.where(inner[place].all(axis=1), angle / 2, angle)
            turn = np.zeros(len(nodes))
            for side in (0, 1):
                np.maximum.at(turn, place[:, side], needed)
            # one part in 1e12 more, so that rounding cannot leave the edge inside the circle
            stretch = np.where(inner, (1 + 1e-12) / np.cos(turn), 1.0)
            centre = np.array(s.centre)
            moved[nodes] = centre + (self.points[nodes] - centre) * stretch[:, None]
        if (signed_areas(moved, self.triangles) <= 0).any():
            raise MeshingError(
                "a fillet's chords are longer than the wall beside it allows: "
                f"{len(self.triangles)} triangles are too few for this outline"
            )
        return moved

    def on_axis(self) -> np.ndarray:
        """Mask (n,) of vertices on r = 0."""
        return self.points[:, 0] < SAME_mm

    @property
    def elements(self) -> int:
        """Number of triangles."""
        return len(self.triangles)

    def longest_edges(self) -> np.ndarray:
        """Longest edge of each triangle (m,) [mm]."""
        return np.asarray(edge_lengths(self.points, self.triangles).max(axis=1))

    @property
    def shortest_edge_mm(self) -> float:
        """Shortest edge of all triangles."""
        return shortest_edge_mm(self.points, self.triangles)

    def segments_of(self, patch: str) -> np.ndarray:
        """Return the indices of the outline's segments that carry a patch name."""
        return np.array([i for i, s in enumerate(self.outline.segments) if s.patch == patch], int)


def signed_areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return areas (m,) [mm²], positive for counter-clockwise triangles."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    u, v = b - a, c - a
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


def edge_middles(
    outline: Meridian, points: np.ndarray, edges: np.ndarray, edge_segment: np.ndarray
) -> np.ndarray:
    """Return middles (k, 2) of boundary edges, on the arc where the segment is one."""
    middle = points[edges].mean(axis=1)
    for index, s in enumerate(outline.segments):
        mine = edge_segment == index
        if s.centre is not None and mine.any():
            radial = middle[mine] - np.array(s.centre)
            middle[mine] = s.centre + radial * (s.radius / np.linalg.norm(radial, axis=1))[:, None]
    return middle
