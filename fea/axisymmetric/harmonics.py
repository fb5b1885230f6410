"""Elasticity of a body of revolution, one Fourier harmonic at a time, on the meridian.

For harmonic n the displacement is u_r = U cos nφ, u_θ = V sin nφ, u_z = W cos nφ. Its strains are

    × cos nφ:   ε_rr = U,r    ε_θθ = (U + nV)/r    ε_zz = W,z    γ_rz = U,z + W,r
    × sin nφ:   γ_rθ = V,r - (V + nU)/r    γ_θz = V,z - nW/r

The other symmetry (u_r = U sin nφ, u_θ = -V cos nφ, u_z = W sin nφ) is the same body turned by
π/2n: same numbers, same energy. For n = 0 it is pure torsion, V alone (`Harmonic.torsion`).
Harmonics do not couple. Source: Wilson, AIAA J. 3 (1965) 2269-2274.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix
from skfem import FacetBasis, LinearForm, MappingAffine

from flexspline.fea.axisymmetric.couplings import Couplings
from flexspline.fea.axisymmetric.factors import PatternSolver, relative_residual
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.space import Space, at_points, curved
from flexspline.fea.cylindrical import AXIAL, RADIAL, TANGENTIAL
from flexspline.fea.quadratic_triangle import CORNERS_AND_MIDDLES
from flexspline.fea.types import Elastic
from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.outline import SAME_mm

DEGREE = 4
"""Degree of the quadrature, of six points. r|∇N|² has degree 3 on straight triangles; the rest is for N²/r
and curved edges. K of six cups under the lobe load is off by 2e-8 at most, with bores of 0 to 6 mm by 9e-9
(degree 6: 5e-11 and 2e-9, in 1.2 times the time)."""
INWARD = 1e-6
"""Fields at nodes are evaluated this far inside the triangle, where u/r is defined even on the axis."""
PRESSURE = LinearForm(lambda v, w: v * w.x[0])
PRESSURE_DEGREE = 3
"""Degree of shape function times radius on a straight edge."""
LOST_ENERGY_LIMIT = 1e-5
"""Largest |u·(Ku - f)| over u·Ku, also of solid models. ‖Ku - f‖/‖f‖ of a flexible body is large by rounding
alone (1e-7 for an unsupported thin cup, 2e-8 for a roof of one layer of tetrahedra), so the residual is
judged by its energy: 1e-11 for that cup, 1.1e-6 for one with a wall of 1/770 of its diameter."""


@dataclass(frozen=True)
class Harmonic:
    """A harmonic: its number, and for n = 0 whether it is torsion (V only) or not (U and W)."""

    n: int
    torsion: bool = False

    @property
    def around(self) -> float:
        """∫ cos² nφ dφ over the circle."""
        return 2 * pi if self.n == 0 else pi

    @property
    def idle(self) -> tuple[int, ...]:
        """Components that this harmonic does not have."""
        if self.n > 0:
            return ()
        return (RADIAL, AXIAL) if self.torsion else (TANGENTIAL,)

    @property
    def components(self) -> tuple[int, ...]:
        """Components that it has."""
        return tuple(c for c in (RADIAL, TANGENTIAL, AXIAL) if c not in self.idle)

    @property
    def zero_on_axis(self) -> tuple[int, ...]:
        """Components that continuity makes 0 at r = 0."""
        if self.n == 0:
            return (RADIAL, TANGENTIAL)
        return (RADIAL, TANGENTIAL, AXIAL)


@dataclass(frozen=True)
class Fixed:
    """Prescribed values [mm] of one displacement component at P2 numbers."""

    numbers: np.ndarray
    component: int
    value: np.ndarray | float = 0.0


class HarmonicError(ComputationError):
    """A harmonic could not be solved; the message carries the numbers."""


@dataclass(frozen=True)
class Amplitudes:
    """A solved harmonic.

    Attributes
    ----------
    values : (3·count,) U, V, W of each P2 number [mm].
    twice_energy : ∫σ:ε over the whole body [N·mm].
    work : nodal forces times displacements [N·mm]; equal to it where no displacement is imposed.
    residual : ‖Ku - f‖/‖f‖ of the free unknowns, whose number is `unknowns`.
    """

    values: np.ndarray
    twice_energy: float
    work: float
    residual: float
    unknowns: int


@dataclass(frozen=True)
class HarmonicModel:
    """A meridian mesh and material, ready for any harmonic but n = 1 on a body that has an axis.

    There u_r and u_θ would be tied to each other at r = 0, which no load case needs.
    """

    mesh: MeridianMesh
    material: Elastic

    @cached_property
    def space(self) -> Space:
        return curved(self.mesh, DEGREE)

    @cached_property
    def nodal_basis(self) -> Any:
        """The same fields seen at the six nodes of each triangle."""
        return at_points(self.space, 1 / 3 + (1 - INWARD) * (CORNERS_AND_MIDDLES - 1 / 3))

    @cached_property
    def couplings(self) -> Couplings:
        """The forms from which all harmonics of this mesh are combined."""
        return Couplings(self.space, self.material)

    @cached_property
    def solver(self) -> PatternSolver:
        """The solver of all harmonics, whose matrices have their entries at the same places."""
        return PatternSolver()

    def stiffness(self, wave: Harmonic) -> csr_matrix:
        """Return a harmonic's stiffness matrix (3·count, 3·count) of the whole circle, without supports.

        Components that the harmonic does not have are left empty.
        """
        return self.couplings.stiffness(wave.n, wave.components, wave.around)

    def on(self, patch: str) -> np.ndarray:
        """Return the P2 numbers on a patch."""
        return self.space.on(patch)

    def held(self, patch: str) -> list[Fixed]:
        """Return the constraints that make all components 0 on a patch."""
        return [Fixed(self.on(patch), c) for c in (RADIAL, TANGENTIAL, AXIAL)]

    def solve(self, wave: Harmonic, fixed: list[Fixed], load: np.ndarray) -> Amplitudes:
        """Return the amplitudes under nodal forces `load` (3·count,) [N]; a later `fixed` wins.

        Raises
        ------
        HarmonicError
            If the solve loses energy: the body is not held.
        """
        free, u = self.prescribed(wave, fixed)
        matrix = self.stiffness(wave)
        inside, right = self.solver.free_part(matrix, free), (load - matrix @ u)[free]
        try:
            u[free] = self.solver.solve(inside, right)
        except (RuntimeError, ComputationError) as fault:  # SuperLU's and Pardiso's: it is singular
            raise HarmonicError(f"harmonic {wave.n}: {fault}; is the body held?") from fault
        twice_energy = float(u @ (matrix @ u))
        lost = abs(float(u[free] @ (inside @ u[free] - right)))
        if not lost < LOST_ENERGY_LIMIT * twice_energy:
            raise HarmonicError(
                f"harmonic {wave.n}: {lost / max(twice_energy, ABOVE_ZERO):.1e} of the energy is lost in "
                f"the solve, allowed {LOST_ENERGY_LIMIT:.0e}; is the body held?"
            )
        residual = relative_residual(inside, u[free], right)
        return Amplitudes(u, twice_energy, float(u @ load), residual, len(right))

    def prescribed(self, wave: Harmonic, fixed: list[Fixed]) -> tuple[np.ndarray, np.ndarray]:
        """Return the mask of the free unknowns, and all unknowns with the values prescribed, else 0."""
        count = self.space.count
        axis = np.flatnonzero(self.space.places[:, 0] < SAME_mm)
        if wave.n == 1 and len(axis):
            raise HarmonicError("harmonic 1 of a body that reaches its axis is not implemented")
        mask, value = np.zeros((count, 3), bool), np.zeros((count, 3))
        idle = [Fixed(np.arange(count), c) for c in wave.idle]
        for f in [*fixed, *idle, *(Fixed(axis, c) for c in wave.zero_on_axis)]:
            mask[f.numbers, f.component] = True
            value[f.numbers, f.component] = f.value
        return ~mask.ravel(), value.ravel()

    def pressed(self, patch: str, component: int, wave: Harmonic) -> np.ndarray:
        """Return nodal forces (3·count,) [N] of a traction of amplitude 1 MPa on a straight patch."""
        load = np.zeros((self.space.count, 3))
        load[:, component] = wave.around * self._pressure(patch)
        return load.ravel()

    def _pressure(self, patch: str) -> np.ndarray:
        """∫ shape function · r ds on a patch, (count,) [mm²]."""
        if patch not in self._pressures:
            # a patch is straight, so corners alone give its points; scikit-fem's search for them in the
            # curved map stops short of its fixed 1e-12 on thin walls
            basis = self.space.basis
            facets = FacetBasis(
                basis.mesh, basis.elem, mapping=MappingAffine(basis.mesh), facets=patch,
                intorder=PRESSURE_DEGREE, dofs=basis.dofs,
            )  # fmt: skip
            self._pressures[patch] = PRESSURE.assemble(facets)
        return self._pressures[patch]

    @cached_property
    def _pressures(self) -> dict[str, np.ndarray]:
        return {}
