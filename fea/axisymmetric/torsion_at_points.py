"""Evaluates a body of revolution's torsion at any points, in Cartesian components."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from skfem import MeshTri

from flexspline.fea.axisymmetric.places import located
from flexspline.fea.axisymmetric.recovery import R_THETA, THETA_Z
from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.cylindrical import TANGENTIAL
from flexspline.fea.quadratic_triangle import shape_functions

DIGITS = 9
"""Of r and z [mm], beyond which two places are one: nodes of a swept mesh share theirs, but for rounding."""


@dataclass(frozen=True)
class TorsionAtPoints:
    """Displacement and smoothed stress of a solved torsion for a turn of 1 rad."""

    field: RevolvedField

    def at(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return displacement (k, 3) [mm] and stress (k, 3, 3) [MPa] at points (k, 3) [mm], all Cartesian.

        Raises
        ------
        MeshingError : as `located`.
        """
        outward, around, along = _directions(points)
        shear = self.field.stress[:, [R_THETA, THETA_Z]]
        moved, *shears = self._seen(
            np.column_stack([self.field.displacement[:, TANGENTIAL], shear]), points
        ).T
        in_plane = shears[0][:, None] * outward + shears[1][:, None] * along
        half = np.einsum("ka,kb->kab", in_plane, around)
        return moved[:, None] * around, half + half.swapaxes(1, 2)

    @cached_property
    def _straight(self) -> MeshTri:
        """The triangles by their corners alone."""
        corners, of = np.unique(self.field.triangles[:, :3], return_inverse=True)
        points, triangles = self.field.places[corners].T, of.reshape(-1, 3).T
        return MeshTri(*map(np.ascontiguousarray, (points, triangles)), sort_t=False)

    @property
    def _angle(self) -> float:
        """Of the driven patch [rad]; no other node turns by more."""
        r = self.field.places[:, 0]
        return float((self.field.displacement[r > 0, TANGENTIAL] / r[r > 0]).max())

    def _seen(self, nodal: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Return values at the P2 nodes (count, c) at points, (k, c), for a turn of 1 rad."""
        x, y, z = points.T
        every = np.stack([np.hypot(x, y), z], axis=1)
        # not the rounded places: these may lie just outside
        _, first, of = np.unique(
            every.round(DIGITS), axis=0, return_index=True, return_inverse=True
        )
        places = every[first]
        triangle, local = located(
            self._straight, self.field.places, self.field.triangles.T, *places.T
        )
        shapes = shape_functions(local)
        nodes = self.field.triangles[triangle].T
        values = sum(
            shape[:, None] * nodal[node] for shape, node in zip(shapes, nodes, strict=True)
        )
        return np.asarray(values)[of.ravel()] / self._angle


def _directions(points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the directions (k, 3) of r, φ and z at points; on the axis those of x, y and z."""
    phi = np.arctan2(points[:, 1], points[:, 0])
    c, s, nought = np.cos(phi), np.sin(phi), np.zeros_like(phi)
    along = np.stack([nought, nought, nought + 1], axis=1)
    return np.stack([c, s, nought], axis=1), np.stack([-s, c, nought], axis=1), along
