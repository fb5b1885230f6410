"""Evaluates fields of a meridian mesh at any point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from skfem import MappingAffine, MeshTri
from skfem.element import DiscreteField

from flexspline.fea.axisymmetric.meridian_mesh import MeshingError
from flexspline.fea.axisymmetric.space import Space
from flexspline.fea.axisymmetric.triangle_search import triangles_of

OUTSIDE = 0.01
"""Share of the mesh's size that a point may lie outside. A mesher's walls may begin 1e-6 mm outside, points
of a parabola 1e-4 of its radius."""
PAIRS = 2_000_000
"""Of points and boundary edges at a time: 16 MB an array."""


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
        """Find points at r, z (k,) [mm]; a point just outside takes the values at the nearest place.

        Raises
        ------
        MeshingError : one is farther outside than OUTSIDE of the mesh's size.
        """
        mesh, element = space.basis.mesh, space.basis.elem
        straight = MeshTri(mesh.p[:, : mesh.t.max() + 1], mesh.t, sort_t=False)
        triangle, local = located(straight, r, z)
        mapping, at = MappingAffine(straight), local[:, :, None]
        shapes = [element.gbasis(mapping, at, i, tind=triangle)[0] for i in range(6)]
        return cls(space.basis.element_dofs[:, triangle], tuple(shapes))

    def see(self, field: np.ndarray) -> Any:
        """Return a field (count,) there as scikit-fem's: values (k,) and slopes `grad` (2, k)."""
        numbered = list(zip(field[self.dofs], self.shapes, strict=True))
        value = sum(amplitude * np.asarray(shape)[:, 0] for amplitude, shape in numbered)
        slope = sum(amplitude * shape.grad[:, :, 0] for amplitude, shape in numbered)
        return DiscreteField(value, grad=slope)


def located(straight: MeshTri, r: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the triangle (k,) of each point r, z (k,) [mm], and its reference coordinates (2, k) there.

    A point just outside is moved to the nearest one of the straight boundary edges. The numbers of a curved
    edge are those of its chord: a point on a fillet's arc takes its own values there.

    Raises
    ------
    MeshingError : one is farther outside than OUTSIDE of the mesh's size.
    """
    points = np.stack([r, z])
    triangle = triangles_of(straight, points)
    outside = np.flatnonzero(triangle < 0)
    if len(outside):
        points[:, outside], triangle[outside] = _on_boundary(straight, points[:, outside])
        away = np.hypot(*points[:, outside] - np.stack([r, z])[:, outside])
        if away.max() > OUTSIDE * np.ptp(straight.p, axis=1).max():
            raise MeshingError(f"{len(outside)} of {len(r)} places are not on the meridian")
    return triangle, MappingAffine(straight).invF(points[:, :, None], tind=triangle)[:, :, 0]


def _on_boundary(straight: MeshTri, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the nearest points (2, k) of the boundary edges, and their triangles (k,)."""
    edges = straight.boundary_facets()
    start, end = straight.p[:, straight.facets[:, edges]].swapaxes(0, 1)
    along = end - start
    nearest, triangle = np.empty_like(points), np.empty(points.shape[1], int)
    for some in np.array_split(np.arange(points.shape[1]), 1 + points.size * len(edges) // PAIRS):
        offset = points[:, some, None] - start[:, None]
        share = np.clip((offset * along[:, None]).sum(axis=0) / (along**2).sum(axis=0), 0, 1)
        left = np.hypot(*offset - share * along[:, None])
        edge, point = left.argmin(axis=1), np.arange(len(some))
        nearest[:, some] = start[:, edge] + share[point, edge] * along[:, edge]
        triangle[some] = straight.f2t[0, edges[edge]]
    return nearest, triangle
