"""Evaluates a harmonic of a body of revolution at any points, in Cartesian components."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from skfem import MeshTri

from flexspline.fea.axisymmetric.places import located
from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.cylindrical import TANGENTIAL
from flexspline.fea.quadratic_triangle import shape_functions

DIGITS = 9
"""Of r and z [mm], beyond which two places are one: nodes of a swept mesh share theirs, but for rounding."""


@dataclass(frozen=True)
class FieldAtPoints:
    """Displacement and smoothed stress of a solved harmonic, under its own load."""

    field: RevolvedField

    def at(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return displacement (k, 3) [mm] and stress (k, 3, 3) [MPa] at points (k, 3) [mm], all Cartesian.

        Raises
        ------
        MeshingError : as `located`.
        """
        x, y, z = points.T
        moved, stress = self.amplitudes(np.hypot(x, y), z)
        phi = np.arctan2(y, x)
        c, s = np.cos(self.field.n * phi), np.sin(self.field.n * phi)
        if not self.field.n:
            s = np.ones_like(phi)  # torsion is constant
        u, v, w = moved.T * [c, s, c]
        rr, tt, zz, rz, rt, tz = stress.T * [c, c, c, c, s, s]
        axes = _directions(phi)
        tensor = np.stack([rr, rt, rz, rt, tt, tz, rz, tz, zz], axis=1).reshape(-1, 3, 3)
        displacement = np.matmul(np.stack([u, v, w], axis=1)[:, None], axes)[:, 0]
        return displacement, np.matmul(axes.swapaxes(1, 2), np.matmul(tensor, axes))

    def amplitudes(self, r: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the amplitudes (k, 3) [mm] and (k, 6) [MPa] of `RevolvedField` at places r, z (k,) [mm].

        Raises
        ------
        MeshingError : as `located`.
        """
        every = np.stack([r, z], axis=1)
        # not the rounded places: these may lie just outside
        _, first, of = np.unique(
            every.round(DIGITS), axis=0, return_index=True, return_inverse=True
        )
        triangle, local = located(self._straight, *every[first].T)
        shapes = shape_functions(local)
        nodes = self.field.triangles[triangle].T
        nodal = np.hstack([self.field.displacement, self.field.stress])
        values = sum(
            shape[:, None] * nodal[node] for shape, node in zip(shapes, nodes, strict=True)
        )
        moved, stress = np.split(np.asarray(values)[of.ravel()], [3], axis=1)
        return moved, stress

    @cached_property
    def turn(self) -> float:
        """Angle [rad] of the driven patch under torsion; no other node turns by more."""
        r = self.field.places[:, 0]
        return float((self.field.displacement[r > 0, TANGENTIAL] / r[r > 0]).max())

    @cached_property
    def _straight(self) -> MeshTri:
        """The triangles by their corners alone."""
        corners, of = np.unique(self.field.triangles[:, :3], return_inverse=True)
        points, triangles = self.field.places[corners].T, of.reshape(-1, 3).T
        return MeshTri(*map(np.ascontiguousarray, (points, triangles)), sort_t=False)


def _directions(phi: np.ndarray) -> np.ndarray:
    """Return the directions of r, φ and z at angles (k,), (k, 3, 3): each a row."""
    c, s, nought, one = np.cos(phi), np.sin(phi), np.zeros_like(phi), np.ones_like(phi)
    rows = [c, s, nought, -s, c, nought, nought, nought, one]
    return np.stack(rows, axis=1).reshape(-1, 3, 3)
