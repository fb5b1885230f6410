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
from flexspline.fea.quadratic_triangle import CORNERS_AND_MIDDLES

OUTSIDE = 0.01
"""Share of the mesh's size that a point may lie outside. A mesher's walls may begin 1e-6 mm outside, points
of a parabola 1e-4 of its radius."""


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
        """Find points at r, z (k,) [mm]; a point just outside takes the values at the nearest number's place.

        Raises
        ------
        MeshingError : one is farther outside than OUTSIDE of the mesh's size.
        """
        mesh, element = space.basis.mesh, space.basis.elem
        straight = MeshTri(mesh.p[:, : mesh.t.max() + 1], mesh.t, sort_t=False)
        triangle, local = located(straight, space.places, space.basis.element_dofs, r, z)
        mapping, at = MappingAffine(straight), local[:, :, None]
        shapes = [element.gbasis(mapping, at, i, tind=triangle)[0] for i in range(6)]
        return cls(space.basis.element_dofs[:, triangle], tuple(shapes))

    def see(self, field: np.ndarray) -> Any:
        """Return a field (count,) there as scikit-fem's: values (k,) and slopes `grad` (2, k)."""
        numbered = list(zip(field[self.dofs], self.shapes, strict=True))
        value = sum(amplitude * np.asarray(shape)[:, 0] for amplitude, shape in numbered)
        slope = sum(amplitude * shape.grad[:, :, 0] for amplitude, shape in numbered)
        return DiscreteField(value, grad=slope)


def located(
    straight: MeshTri, numbers: np.ndarray, cells: np.ndarray, r: np.ndarray, z: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the triangle (k,) of each point r, z (k,) [mm], and its reference coordinates (2, k) there.

    `numbers` (count, 2) are the places of the P2 numbers, `cells` (6, m) each triangle's numbers. A point
    just outside is moved to the nearest number, which may lie outside of straight edges itself: on an arc.

    Raises
    ------
    MeshingError : one is farther outside than OUTSIDE of the mesh's size.
    """
    from scipy.spatial import cKDTree

    points = np.stack([r, z])
    triangle = triangles_of(straight, points)
    outside = triangle < 0
    triangle[outside] = 0
    local = MappingAffine(straight).invF(points[:, :, None], tind=triangle)[:, :, 0]
    if outside.any():
        away, nearest = cKDTree(numbers).query(points[:, outside].T)
        if away.max() > OUTSIDE * np.ptp(straight.p, axis=1).max():
            raise MeshingError(f"{outside.sum()} of {len(r)} places are not on the meridian")
        owner = np.zeros(len(numbers), int)
        owner[cells.ravel()] = np.arange(cells.size)
        of_cell, triangle[outside] = np.divmod(owner[nearest], cells.shape[1])
        local[:, outside] = CORNERS_AND_MIDDLES[:, of_cell]
    return triangle, local
