"""Triangles swept into prisms, about the axis or along it, and prisms cut into tetrahedra.

Source of the cut: Dompierre, Labbé, Vallet, Camarero, How to subdivide pyramids, prisms and hexahedra
into tetrahedra, 8th International Meshing Roundtable (1999).
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.solid.column import HOLE, INTERFACE, HoledColumn
from flexspline.geometry.outline import SAME_mm

FILLED_RADII = (0.6, 0.25)
"""Radii of two rings of nodes within a hole's circle, over the hole's radius, where material closes the hole
above. Judgement."""
ROTATIONS = np.array([
    [0, 1, 2, 3, 4, 5], [1, 2, 0, 4, 5, 3], [2, 0, 1, 5, 3, 4],
    [3, 5, 4, 0, 2, 1], [4, 3, 5, 1, 0, 2], [5, 4, 3, 2, 1, 0],
])  # fmt: skip
"""A prism's corners (three, and the three over them) turned so that corner k comes first."""
CUTS = (
    np.array([[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]]),
    np.array([[0, 1, 2, 4], [0, 4, 2, 5], [0, 4, 5, 3]]),
)
"""Corners of the three tetrahedra of a prism whose least node is corner 0: both quadrilaterals at it are
cut from it, and the face opposite from 1 to 5, or from 2 to 4 (Dompierre et al., How to subdivide pyramids,
prisms and hexahedra into tetrahedra, 1999)."""


def revolved(rest: MeridianMesh, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes (r, φ, z) vertex by vertex, each at all angles, and prisms between neighbouring angles.

    A triangle that is counter-clockwise in (r, z) is clockwise seen along φ: its order is turned, so
    that every prism, here and in `extruded`, has its second triangle on the positive side of the first.
    A vertex on the axis is one node, the first of its own; prisms there have it twice.
    """
    n, k = len(rest.points), len(angles)
    polar = np.column_stack(
        [np.repeat(rest.points[:, 0], k), np.tile(angles, n), np.repeat(rest.points[:, 1], k)]
    )
    number = np.arange(n * k).reshape(n, k)
    on_axis = rest.on_axis()
    number[on_axis] = number[on_axis, :1]
    base = number[rest.triangles[:, ::-1]]
    return polar, np.vstack([np.hstack([base[..., i], base[..., i + 1]]) for i in range(k - 1)])


def extruded(
    plan: MeridianMesh, column: HoledColumn, rest: MeridianMesh, seam: np.ndarray, offset: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the column's nodes, numbered from `offset`, and its prisms, which use the interface's nodes."""
    line = along(rest, INTERFACE)
    line = line[np.argsort(rest.points[line, 1])]
    z = rest.points[line, 1]
    points, filling = _filled_hole(plan, column)
    n, k = len(points), len(z)
    number = offset + np.arange(n * k).reshape(n, k)
    number[seam] = line * len(seam) + np.arange(len(seam))[:, None]
    r, phi = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
    polar = np.column_stack([np.repeat(r, k), np.repeat(phi, k), np.tile(z, n)])
    prisms = []
    for level in range(k - 1):
        closed = z[level] > column.depth - SAME_mm
        flat = np.vstack([plan.triangles, filling]) if closed else plan.triangles
        prisms.append(np.hstack([number[flat, level], number[flat, level + 1]]))
    return polar, np.vstack(prisms)


def _filled_hole(plan: MeridianMesh, column: HoledColumn) -> tuple[np.ndarray, np.ndarray]:
    """Plan points (n, 2) with those inside a blind hole's half circle, and its triangles there."""
    if not column.blind:
        return plan.points, np.empty((0, 3), np.int64)
    centre = np.array([column.bolt_circle, 0.0])
    rim = along(plan, HOLE)
    off = plan.points[rim] - centre
    rim = rim[np.argsort(np.arctan2(off[:, 1], off[:, 0]))]
    points, rings = [plan.points], [rim]
    for share in FILLED_RADII:
        rings.append(sum(map(len, points)) + np.arange(len(rim)))
        points.append(centre + share * (plan.points[rim] - centre))
    middle = sum(map(len, points))
    triangles = []
    for a, b in pairwise(rings):
        triangles.append(np.column_stack([a[:-1], a[1:], b[:-1]]))
        triangles.append(np.column_stack([a[1:], b[1:], b[:-1]]))
    last = rings[-1]
    triangles.append(np.column_stack([last[:-1], last[1:], np.full(len(last) - 1, middle)]))
    return np.vstack([*points, centre]), np.vstack(triangles)


def mirrored(angles: np.ndarray, wedge: float, k: int) -> np.ndarray:
    """Return angles [rad] of a wedge in the k-th of its images, each the mirror image of the last."""
    return k * wedge + (angles if k % 2 == 0 else wedge - angles)


def unrolled_copies(
    polar: np.ndarray, prisms: np.ndarray, wedge: float, copies: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes (r, φ, z) and prisms of a wedge and its mirror images; shared nodes are there once."""
    nodes, cells = [], []
    for k in range(copies):
        image = polar.copy()
        image[:, 1] = mirrored(polar[:, 1], wedge, k)
        image[polar[:, 0] < SAME_mm, 1] = 0.0  # on the axis all angles are one
        nodes.append(image)
        turned = [0, 1, 2, 3, 4, 5] if k % 2 == 0 else [0, 2, 1, 3, 5, 4]
        cells.append(prisms[:, turned] + k * len(polar))
    stacked = np.vstack(nodes)
    _, first, number = np.unique(
        np.round(stacked / SAME_mm), axis=0, return_index=True, return_inverse=True
    )
    return stacked[first], number.ravel()[np.vstack(cells)]


def cut(prisms: np.ndarray) -> np.ndarray:
    """Cut each prism into three tetrahedra; shared faces are cut alike, from their least node.

    They are positive as the prism is. Of a prism with a node twice, on the axis, two are left, or one.
    """
    v = np.take_along_axis(prisms, ROTATIONS[prisms.argmin(axis=1)], axis=1)
    first = np.minimum(v[:, 1], v[:, 5]) < np.minimum(v[:, 2], v[:, 4])
    tets = np.vstack([v[first][:, CUTS[0]].reshape(-1, 4), v[~first][:, CUTS[1]].reshape(-1, 4)])
    return tets[(np.diff(np.sort(tets, axis=1), axis=1) > 0).all(axis=1)]


def along(mesh: MeridianMesh, patch: str) -> np.ndarray:
    """Return the vertices on a patch of the outline."""
    return np.unique(mesh.edges[np.isin(mesh.edge_segment, mesh.segments_of(patch))])
