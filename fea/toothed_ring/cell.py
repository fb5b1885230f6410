"""Stiffnesses of a ring of equal teeth from half a pitch, each approached from above.

The fields are quadratic in (r, ρφ), the polar components of displacement among them: every boundary
but the flank is a coordinate line, so the symmetry planes and the seat are met exactly, and the
principle of minimum potential energy holds on each mesh:

- bending: the sections through the tooth's and the gap's centre stay plane, free of shear, and turn
  by δ (u_φ = δ (r − root) on one, 0 on the other). Both are free to move radially. Two such planes
  that are not parallel carry no net force, so the moment is pure; another turning centre would add
  a rigid translation and no energy;
- membrane: both sections keep their planes, and the seat moves outwards by 1 without friction;
- torsion about z after Saint-Venant: ∫ |∇ω + r e_φ|², warping ω = 0 on both planes, as antisymmetry
  asks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix

from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.points import VALUE
from flexspline.fea.axisymmetric.space import Space, quadratic, relative_residual, solved, summed
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.tooth import ToothCell

DEGREE = 6
"""Of quadrature: exact for r·|∇u|² and more; 1/r varies little over an element."""
LARGEST_RESIDUAL = 1e-8
"""Of ‖Ku − f‖/‖f‖: far below the error of the mesh."""
RADIAL, TANGENTIAL = 0, 1


class ToothedRingError(ComputationError):
    """The toothed ring's equation was not solved; the message carries the numbers."""


@dataclass(frozen=True)
class CellModel:
    """One mesh of a tooth cell in the plane (r, ρφ)."""

    cell: ToothCell
    mesh: MeridianMesh

    @cached_property
    def space(self) -> Space:
        return quadratic(self.mesh, self.mesh.points, DEGREE)

    def bending(self, poissons_ratio: float) -> float:
        """As `plain.bending`: M/E' per δ/θ [mm³]. No Poisson's ratio changes it."""
        turned = {
            **self._on("tooth", TANGENTIAL, np.zeros_like),
            **self._on("space", TANGENTIAL, lambda r: r - self.cell.root),
        }
        twice_energy = self._plane_strain(poissons_ratio, turned)
        return twice_energy * self.cell.half_pitch

    def membrane(self, poissons_ratio: float) -> float:
        """As `plain.membrane`: mean pressure/E' per radial displacement of the seat [1/mm]."""
        grown = {
            **self._on("tooth", TANGENTIAL, np.zeros_like),
            **self._on("space", TANGENTIAL, np.zeros_like),
            **self._on("seat", RADIAL, np.ones_like),
        }
        twice_energy = self._plane_strain(poissons_ratio, grown)
        return twice_energy / (self.cell.inner * self.cell.half_pitch)

    def torsion(self) -> float:
        """As `plain.torsion`: J of the whole ring [mm⁴]."""
        s = self.space
        along, around = self._slopes()
        area = self._area
        gradient = np.stack([along, around], -1)  # (m, 6, q, 2)
        scaled = gradient * area[:, None, :, None]
        m = len(s.dofs)
        matrix = summed(
            scaled.reshape(m, 6, -1) @ gradient.reshape(m, 6, -1).transpose(0, 2, 1),
            s.dofs,
            s.count,
        )
        load = -np.bincount(s.dofs.ravel(), (scaled[..., 1] @ s.r[..., None]).ravel(), s.count)
        planes = np.concatenate([self.mesh.segments_of("tooth"), self.mesh.segments_of("space")])
        free = np.setdiff1d(np.arange(s.count), s.on(self.mesh, planes))
        warping = _solved(matrix[free][:, free], load[free])
        polar = float((area * s.r**2).sum())
        # the minimum of |∇ω|² + 2 r·∇ω + r²; at it the first is half the second, of other sign
        return (polar - float(load[free] @ warping)) * 2 * np.pi / self.cell.half_pitch

    @property
    def _area(self) -> np.ndarray:
        """Quadrature weights (m, q) of the cell itself, r dr dφ [mm²]."""
        return self.space.weights * self.space.r / self.cell.unroll

    def _slopes(self) -> tuple[np.ndarray, np.ndarray]:
        """∂/∂r and (1/r)∂/∂φ of the shape functions, each (m, 6, q) [1/mm]."""
        by_r, by_z = self.space.shape_slopes()
        return by_r, by_z * (self.cell.unroll / self.space.r)[:, None, :]

    def _on(
        self, patch: str, component: int, value: Callable[[np.ndarray], np.ndarray]
    ) -> dict[int, float]:
        """The value at each radius, by number 2·node + component, on a patch."""
        on = self.space.on(self.mesh, self.mesh.segments_of(patch))
        values = value(self.space.places[on, 0])
        return dict(zip((2 * on + component).tolist(), values.tolist(), strict=True))

    def _plane_strain(self, poissons_ratio: float, given: dict[int, float]) -> float:
        """∫ σ:ε / E' with the given displacements, the others free; numbers as in `_on`."""
        s, nu = self.space, poissons_ratio
        along, around = self._slopes()
        over_r = s.points.reference.functions[VALUE] / s.r[:, None, :]
        m, _, q = along.shape
        parts = np.zeros((m, q, 3, 6, 2))  # rr, φφ, shear
        to_points = (0, 2, 1)
        parts[:, :, 0, :, RADIAL] = along.transpose(to_points)
        parts[:, :, 1, :, RADIAL] = over_r.transpose(to_points)
        parts[:, :, 1, :, TANGENTIAL] = around.transpose(to_points)
        parts[:, :, 2, :, RADIAL] = around.transpose(to_points)
        parts[:, :, 2, :, TANGENTIAL] = (along - over_r).transpose(to_points)
        strain = parts.reshape(m, q, 3, 12)
        c = nu / (1 - nu)
        hooke = np.array([[1, c, 0], [c, 1, 0], [0, 0, (1 - c) / 2]]) / (1 - c * c)
        stress = np.einsum("ab,mqbi->mqai", hooke, strain) * self._area[:, :, None, None]
        local = strain.reshape(m, -1, 12).transpose(0, 2, 1) @ stress.reshape(m, -1, 12)
        numbers = (2 * s.dofs[:, :, None] + np.arange(2)).reshape(m, 12)
        matrix = summed(local, numbers, 2 * s.count)
        u = np.zeros(2 * s.count)
        u[list(given)] = list(given.values())
        free = np.setdiff1d(np.arange(2 * s.count), list(given))
        u[free] = _solved(matrix[free][:, free], -(matrix @ u)[free])
        return float(u @ (matrix @ u))


def _solved(matrix: csc_matrix, load: np.ndarray) -> np.ndarray:
    found = solved(matrix, load)
    residual = relative_residual(matrix, found, load)
    if not residual < LARGEST_RESIDUAL:
        raise ToothedRingError(f"residual {residual:.1e} of {len(load)} equations is too large")
    return found
