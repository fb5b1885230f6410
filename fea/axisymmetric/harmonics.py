"""Elasticity of a body of revolution, one Fourier harmonic at a time, on the meridian.

For harmonic n the displacement is u_r = U cos nφ, u_θ = V sin nφ, u_z = W cos nφ. Its strains are

    × cos nφ:   ε_rr = U,r    ε_θθ = (U + nV)/r    ε_zz = W,z    γ_rz = U,z + W,r
    × sin nφ:   γ_rθ = V,r - (V + nU)/r    γ_θz = V,z - nW/r

The other symmetry (u_r = U sin nφ, u_θ = -V cos nφ, u_z = W sin nφ) is the same body turned by
π/2n: same numbers, same energy. For n = 0 it is pure torsion, V alone (`Wave.torsion`).
Harmonics do not couple. Source: Wilson, AIAA J. 3 (1965) 2269-2274.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np
from scipy.sparse import csc_matrix

from fea.axisymmetric.meridian_mesh import MeridianMesh
from fea.axisymmetric.space import Space, isoparametric, relative_residual, solved, summed
from fea.types import Elastic
from geometry.errors import ComputationError
from geometry.outline import SAME

DEGREE = 6
"""Of quadrature: r|∇N|² has degree 3 on straight triangles; the rest serves N²/r and curves."""
RADIAL, TANGENTIAL, AXIAL = 0, 1, 2
LOST_ENERGY_LIMIT = 1e-6
"""Largest |u·(Ku - f)| over u·Ku. A floppy body's ‖Ku - f‖/‖f‖ is large by rounding alone (1e-7 for an
unsupported thin cup), so the residual is judged by the energy it carries: there 1e-11."""
COSINE, SINE = slice(0, 4), slice(4, 6)
"""Which of the six strains (rr, θθ, zz, rz, rθ, θz) vary as cos nφ, which as sin nφ."""


@dataclass(frozen=True)
class Wave:
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
        return isoparametric(self.mesh, DEGREE)

    def strain(
        self, n: int, values: np.ndarray, gradients: np.ndarray, r: np.ndarray
    ) -> np.ndarray:
        """Strains (m, q, 6, 18) of unit displacements; values (6, q), gradients (m, 6, q, 2)."""
        still, turning = _strain_parts(values, gradients, r)
        return still + n * turning

    @cached_property
    def _parts(self) -> tuple[csc_matrix, csc_matrix, csc_matrix]:
        """Stiffness per ∫cos², as the coefficients of 1, n, n²."""
        s = self.space
        m = len(s.dofs)
        weight = (s.weights * s.r)[..., None, None]
        still, turning = _strain_parts(s.values, s.gradients, s.r)
        stress = elasticity(self.material)
        both = (still, turning)
        left = [(weight * (stress @ b)).reshape(m, -1, 18).transpose(0, 2, 1) for b in both]
        right = [b.reshape(m, -1, 18) for b in both]
        mixed = left[0] @ right[1]
        local = (left[0] @ right[0], mixed + mixed.transpose(0, 2, 1), left[1] @ right[1])
        numbers = self.numbers
        first, second, third = (summed(k, numbers, 3 * s.count) for k in local)
        return first, second, third

    def stiffness(self, wave: Wave) -> csc_matrix:
        """Stiffness matrix (3·count, 3·count) of a harmonic, whole circle, before any support."""
        first, second, third = self._parts
        return wave.around * (first + wave.n * second + wave.n**2 * third)

    @property
    def numbers(self) -> np.ndarray:
        """Unknowns (m, 18) of each triangle: three components of its six P2 numbers."""
        return (3 * self.space.dofs[:, :, None] + np.arange(3)).reshape(-1, 18)

    def on(self, patch: str) -> np.ndarray:
        """P2 numbers on a patch."""
        return self.space.on(self.mesh, self.mesh.segments_of(patch))

    def held(self, patch: str) -> list[Fixed]:
        """All components 0 on a patch."""
        return [Fixed(self.on(patch), c) for c in (RADIAL, TANGENTIAL, AXIAL)]

    def solve(self, wave: Wave, fixed: list[Fixed], load: np.ndarray) -> Amplitudes:
        """Amplitudes under nodal forces `load` (3·count,) [N]; a later `fixed` wins.

        Raises
        ------
        HarmonicError
            If the solve loses energy: the body is not held.
        """
        matrix = self.stiffness(wave)
        at, u = self.prescribed(wave, fixed)
        free = np.setdiff1d(np.arange(len(u)), at, assume_unique=True)
        right = (load - matrix @ u)[free]
        inside = matrix[free][:, free]
        try:
            u[free] = solved(inside, right)
        except RuntimeError as fault:  # SuperLU's word for an exactly singular matrix
            raise HarmonicError(f"harmonic {wave.n}: {fault}; is the body held?") from fault
        twice_energy = float(u @ (matrix @ u))
        lost = abs(float(u[free] @ (inside @ u[free] - right)))
        if not lost < LOST_ENERGY_LIMIT * twice_energy:
            raise HarmonicError(
                f"harmonic {wave.n}: {lost / max(twice_energy, 1e-300):.1e} of the energy is lost in "
                f"the solve, allowed {LOST_ENERGY_LIMIT:.0e}; is the body held?"
            )
        residual = relative_residual(inside, u[free], right)
        return Amplitudes(u, twice_energy, float(u @ load), residual, len(free))

    def prescribed(self, wave: Wave, fixed: list[Fixed]) -> tuple[np.ndarray, np.ndarray]:
        """Indices of prescribed unknowns, and all unknowns with their values there, else 0."""
        count = self.space.count
        axis = np.flatnonzero(self.space.places[:, 0] < SAME)
        if wave.n == 1 and len(axis):
            raise HarmonicError("harmonic 1 of a body with an axis is not provided for")
        mask, value = np.zeros((count, 3), bool), np.zeros((count, 3))
        idle = [Fixed(np.arange(count), c) for c in wave.idle]
        for f in [*fixed, *idle, *(Fixed(axis, c) for c in wave.zero_on_axis)]:
            mask[f.numbers, f.component] = True
            value[f.numbers, f.component] = f.value
        return np.flatnonzero(mask), value.ravel()

    def pressed(self, patch: str, component: int, wave: Wave) -> np.ndarray:
        """Nodal forces (3·count,) [N] of a traction of amplitude 1 MPa on a straight patch."""
        s = self.space
        load = np.zeros(3 * s.count)
        mine = np.isin(self.mesh.edge_segment, self.mesh.segments_of(patch))
        rim = s.rim[mine]
        ends = s.places[rim[:, :2]]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        x, w = np.polynomial.legendre.leggauss(3)  # shape × radius has degree 3
        t = (x + 1) / 2
        shape = np.stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)])
        r = ends[:, :1, 0] + t * (ends[:, 1:, 0] - ends[:, :1, 0])
        forces = wave.around * np.einsum("q,iq,kq,k->ki", w / 2, shape, r, length)
        np.add.at(load, 3 * rim + component, forces)
        return load


def elasticity(material: Elastic) -> np.ndarray:
    """Hooke's law (6, 6) [MPa] for (rr, θθ, zz, γ_rz, γ_rθ, γ_θz)."""
    c = np.diag([2 * material.mu] * 3 + [material.mu] * 3)
    c[:3, :3] += material.lam
    return c


def _strain_parts(
    values: np.ndarray, gradients: np.ndarray, r: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Strains of unit displacements (m, q, 6, 18), and how they grow with n."""
    by_r, by_z = gradients[..., 0].transpose(0, 2, 1), gradients[..., 1].transpose(0, 2, 1)
    over_r = values.T / r[..., None]
    still = np.zeros((*r.shape, 6, 6, 3))
    turning = np.zeros_like(still)
    still[:, :, 0, :, RADIAL] = by_r
    still[:, :, 1, :, RADIAL] = over_r
    still[:, :, 2, :, AXIAL] = by_z
    still[:, :, 3, :, RADIAL] = by_z
    still[:, :, 3, :, AXIAL] = by_r
    still[:, :, 4, :, TANGENTIAL] = by_r - over_r
    still[:, :, 5, :, TANGENTIAL] = by_z
    turning[:, :, 1, :, TANGENTIAL] = over_r
    turning[:, :, 4, :, RADIAL] = -over_r
    turning[:, :, 5, :, AXIAL] = -over_r
    shape = (*r.shape, 6, 18)
    return still.reshape(shape), turning.reshape(shape)
