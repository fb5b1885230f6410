"""Points along a solid's sharp edges and patch edges, near which stress is excluded."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

import numpy as np

from flexspline.geometry.outline import SMOOTH_rad
from flexspline.geometry.surfaces import HoleWall, Surface

if TYPE_CHECKING:
    import cadquery as cq


def sharp_edges(
    solid: cq.Solid, face_surface: dict[int, int], surfaces: list[Surface], spacing: float
) -> tuple[np.ndarray, np.ndarray]:
    """Points along the edges where the normal turns or the patch changes: all, and the critical ones.

    Edges on a plane of symmetry are not edges of the part.
    """
    faces_at: dict[int, list[cq.Face]] = defaultdict(list)
    edges = {}
    for face in solid.Faces():
        for edge in face.Edges():
            edges[edge.hashCode()] = edge
            faces_at[edge.hashCode()].append(face)
    sharp, critical = [np.empty((0, 3))], [np.empty((0, 3))]
    for key, edge in edges.items():
        if len(faces_at[key]) != 2:
            continue
        a, b = (surfaces[face_surface[f.hashCode()]] for f in faces_at[key])
        if "symmetry" in a.patch or "symmetry" in b.patch:
            continue
        turn = _turn(edge, *faces_at[key])
        if a.patch == b.patch and abs(turn) < SMOOTH_rad:
            continue
        n = max(2, int(np.ceil(edge.Length() / spacing)) + 1)
        points = np.array([edge.positionAt(t).toTuple() for t in np.linspace(0, 1, n)])
        sharp.append(points)
        on_hole = isinstance(a, HoleWall) or isinstance(b, HoleWall)
        if not on_hole and (a.patch != b.patch or turn <= -SMOOTH_rad):
            critical.append(points)
    return np.concatenate(sharp), np.concatenate(critical)


def _turn(edge: cq.Edge, one: cq.Face, other: cq.Face) -> float:
    """Sine of the angle between the faces' normals at an edge's middle: negative at an inside corner.

    It is 0 too at the knife edge of a fillet that begins over a blind hole's end: no stress is left out
    there.
    """
    middle = edge.positionAt(0.5)
    n, m = one.normalAt(middle), other.normalAt(middle)
    across = n.cross(m).Length
    # the direction from the edge into face `one`: on an outside corner it points away from m
    inward = one.Center().sub(middle)
    inward = inward.sub(n.multiply(inward.dot(n)))
    return across if inward.dot(m) < 0 else -across
