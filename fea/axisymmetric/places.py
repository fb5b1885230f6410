"""Fields on a meridian mesh, looked at anywhere in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree
from skfem import MappingAffine, MeshTri
from skfem.element import DiscreteField

from flexspline.fea.axisymmetric.meridian_mesh import MeshingError
from flexspline.fea.axisymmetric.space import Space

NEAREST = (8, 64)
"""Triangles by their centres that a point is looked for in, before all of them."""
CANDIDATES = 1_000_000
"""Pairs of point and triangle at once: 100 MB."""
TOUCH = 1e-9
"""How far, in shares of its height, a point may lie beyond its triangle's side: rounding."""


@dataclass(frozen=True)
class Places:
    """Points (k,) in the triangles of a space, by straight edges.

    Attributes
    ----------
    dofs : (6, k) numbers of the triangle that each lies in.
    shapes : its six functions there, as scikit-fem has them.
    """

    dofs: np.ndarray
    shapes: tuple[Any, ...]

    @classmethod
    def of(cls, space: Space, r: np.ndarray, z: np.ndarray) -> Places:
        """Points at r, z (k,) [mm].

        Raises
        ------
        MeshingError : one is outside of the mesh.
        """
        mesh, element = space.basis.mesh, space.basis.elem
        straight = MeshTri(mesh.p[:, : mesh.t.max() + 1], mesh.t, sort_t=False)
        mapping, points = MappingAffine(straight), np.stack([r, z])
        triangle = _triangles_of(straight, points)
        local = mapping.invF(points[:, :, None], tind=triangle)
        shapes = [element.gbasis(mapping, local, i, tind=triangle)[0] for i in range(6)]
        return cls(space.basis.element_dofs[:, triangle], tuple(shapes))

    def see(self, field: np.ndarray) -> Any:
        """A field (count,) there: scikit-fem's, its values (k,) and slopes `grad` (2, k)."""
        numbered = list(zip(field[self.dofs], self.shapes, strict=True))
        value = sum(own * np.asarray(shape)[:, 0] for own, shape in numbered)
        slope = sum(own * shape.grad[:, :, 0] for own, shape in numbered)
        return DiscreteField(value, grad=slope)


def _triangles_of(mesh: Any, points: np.ndarray) -> np.ndarray:
    """Which triangle of scikit-fem's mesh each point (2, k) is in.

    Its own finder looks at all triangles for all points where five are not enough for one of them: 2.6 s for
    9 000 points in 9 000 triangles, 0.1 s here.

    Raises
    ------
    MeshingError
    """
    corner = mesh.p[:, mesh.t]
    tree = cKDTree(corner.mean(axis=1).T)
    found, left = np.full(points.shape[1], -1), np.arange(points.shape[1])
    for count in (*NEAREST, mesh.nelements):
        for mine in np.array_split(left, 1 + len(left) * count // CANDIDATES):
            _, near = tree.query(points[:, mine].T, min(count, mesh.nelements))
            near = near.reshape(len(mine), -1)
            first, second = (corner[:, i, near] - corner[:, 0, near] for i in (1, 2))
            off = points[:, mine, None] - corner[:, 0, near]
            area = first[0] * second[1] - first[1] * second[0]
            x = (off[0] * second[1] - off[1] * second[0]) / area
            y = (first[0] * off[1] - first[1] * off[0]) / area
            inside = np.minimum(np.minimum(x, y), 1 - x - y)
            best = inside.argmax(axis=1)[:, None]
            within = np.take_along_axis(inside, best, 1)[:, 0] > -TOUCH
            found[mine[within]] = np.take_along_axis(near, best, 1)[within, 0]
        left = np.flatnonzero(found < 0)
        if not len(left):
            return found
    raise MeshingError(f"{len(left)} of {len(found)} places are not on the meridian")
