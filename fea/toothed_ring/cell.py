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
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix
from skfem import BilinearForm, Functional, LinearForm, bmat, condense

from flexspline.fea.axisymmetric.factors import relative_residual, solved
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.space import Space, straight
from flexspline.fea.cylindrical import RADIAL, TANGENTIAL
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.tooth import ToothCell

DEGREE = 6
"""Of quadrature: exact for r·|∇u|² and more; 1/r varies little over an element."""
LARGEST_RESIDUAL = 1e-8
"""Largest ‖Ku − f‖/‖f‖: far below the error of the mesh."""


def _around(f: Any, w: Any) -> Any:
    """(1/r) ∂f/∂φ of a field in (r, ρφ)."""
    return f.grad[1] * w.rho / w.x[0]


def _area(w: Any) -> Any:
    """r dr dφ per dr d(ρφ)."""
    return w.x[0] / w.rho


def _shear(f: Any, w: Any) -> Any:
    """γ_rφ of a tangential displacement."""
    return f.grad[0] - f / w.x[0]


# plane strain per E': σ_rr = a ε_rr + b ε_φφ, σ_φφ = b ε_rr + a ε_φφ, τ = g γ;
# ε_rr = U,r  ε_φφ = U/r + V,φ/r  γ = U,φ/r + V,r - V/r; the test function comes second
RADIAL_RADIAL = BilinearForm(
    lambda u, v, w: (
        (
            (w.a * u.grad[0] + w.b * u / w.x[0]) * v.grad[0]
            + (w.b * u.grad[0] + w.a * u / w.x[0]) * v / w.x[0]
            + w.g * _around(u, w) * _around(v, w)
        )
        * _area(w)
    )
)
RADIAL_TANGENTIAL = BilinearForm(
    lambda u, v, w: (
        (
            w.b * _around(u, w) * v.grad[0]
            + w.a * _around(u, w) * v / w.x[0]
            + w.g * _shear(u, w) * _around(v, w)
        )
        * _area(w)
    )
)
TANGENTIAL_TANGENTIAL = BilinearForm(
    lambda u, v, w: (
        (w.a * _around(u, w) * _around(v, w) + w.g * _shear(u, w) * _shear(v, w)) * _area(w)
    )
)
WARPING = BilinearForm(
    lambda u, v, w: (u.grad[0] * v.grad[0] + _around(u, w) * _around(v, w)) * _area(w)
)
ROTATION = LinearForm(lambda v, w: _around(v, w) * w.x[0] * _area(w))
POLAR_MOMENT = Functional(lambda w: w.x[0] ** 2 * _area(w))


class ToothedRingError(ComputationError):
    """The toothed ring's equation was not solved; the message carries the numbers."""


@dataclass(frozen=True)
class CellModel:
    """One mesh of a tooth cell in the plane (r, ρφ)."""

    cell: ToothCell
    mesh: MeridianMesh

    @cached_property
    def space(self) -> Space:
        names = {s.patch for s in self.mesh.outline.segments if s.patch}
        patches = {name: self.mesh.segments_of(name) for name in names}
        return straight(self.mesh, self.mesh.points, DEGREE, patches)

    def bending(self, poissons_ratio: float) -> float:
        """Return M/E' per δ/θ [mm³], as `plain.bending`; it does not depend on Poisson's ratio."""
        turned = {
            **self._on("tooth", TANGENTIAL, np.zeros_like),
            **self._on("space", TANGENTIAL, lambda r: r - self.cell.root),
        }
        twice_energy = self._plane_strain(poissons_ratio, turned)
        return twice_energy * self.cell.half_pitch

    def membrane(self, poissons_ratio: float) -> float:
        """Return the mean pressure/E' per radial displacement of the seat [1/mm], as `plain.membrane`."""
        grown = {
            **self._on("tooth", TANGENTIAL, np.zeros_like),
            **self._on("space", TANGENTIAL, np.zeros_like),
            **self._on("seat", RADIAL, np.ones_like),
        }
        twice_energy = self._plane_strain(poissons_ratio, grown)
        return twice_energy / (self.cell.inner * self.cell.half_pitch)

    def torsion(self) -> float:
        """Return J of the whole ring [mm⁴], as `plain.torsion`."""
        basis, rho = self.space.basis, self.cell.unroll
        matrix = WARPING.assemble(basis, rho=rho)
        load = -ROTATION.assemble(basis, rho=rho)
        planes = basis.get_dofs({"tooth", "space"})
        inside, right = condense(matrix, load, D=planes, expand=False)
        warping = _solved(inside, right)
        polar = float(POLAR_MOMENT.assemble(basis, rho=rho))
        # the minimum of |∇ω|² + 2 r·∇ω + r²; at it the first is half the second, of other sign
        return (polar - float(right @ warping)) * 2 * np.pi / self.cell.half_pitch

    def _on(
        self, patch: str, component: int, value: Callable[[np.ndarray], np.ndarray]
    ) -> dict[int, float]:
        """The value at each radius, by number component·count + node, on a patch."""
        on = self.space.on(patch)
        values = value(self.space.places[on, 0])
        return dict(zip((component * self.space.count + on).tolist(), values.tolist(), strict=True))

    def _plane_strain(self, poissons_ratio: float, given: dict[int, float]) -> float:
        """∫ σ:ε / E' with the given displacements, the others free; numbers as in `_on`."""
        basis, c = self.space.basis, poissons_ratio / (1 - poissons_ratio)
        scale = 1 / (1 - c * c)
        hooke = {"a": scale, "b": c * scale, "g": (1 - c) / 2 * scale, "rho": self.cell.unroll}
        rr, rt, tt = (
            form.assemble(basis, **hooke)
            for form in (RADIAL_RADIAL, RADIAL_TANGENTIAL, TANGENTIAL_TANGENTIAL)
        )
        matrix = bmat([[rr, rt], [rt.T, tt]], "csr")
        u = np.zeros(2 * self.space.count)
        u[list(given)] = list(given.values())
        free = np.setdiff1d(np.arange(len(u)), list(given))
        u[free] = _solved(*condense(matrix, x=u, I=free, expand=False))
        return float(u @ (matrix @ u))


def _solved(matrix: csr_matrix, load: np.ndarray) -> np.ndarray:
    solution = solved(matrix, load)
    residual = relative_residual(matrix, solution, load)
    if not residual < LARGEST_RESIDUAL:
        raise ToothedRingError(f"residual {residual:.1e} of {len(load)} equations is too large")
    return solution
