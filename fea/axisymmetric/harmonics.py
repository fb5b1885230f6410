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

from flexspline.fea.axisymmetric.couplings import (
    AXIAL,
    RADIAL,
    TANGENTIAL,
    Couplings,
    Layout,
    layout_of,
)
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.space import Space, isoparametric, relative_residual, solved
from flexspline.fea.types import Elastic
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.outline import SAME

DEGREE = 6
"""Of quadrature: r|∇N|² has degree 3 on straight triangles; the rest serves N²/r and curves."""
LOST_ENERGY_LIMIT = 1e-6
"""Largest |u·(Ku - f)| over u·Ku. A floppy body's ‖Ku - f‖/‖f‖ is large by rounding alone (1e-7 for an
unsupported thin cup), so the residual is judged by the energy it carries: there 1e-11."""


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
        return isoparametric(self.mesh, DEGREE)

    @cached_property
    def couplings(self) -> Couplings:
        """What all harmonics of this mesh are made of."""
        return Couplings(self.space, self.material)

    @cached_property
    def _layouts(self) -> dict[tuple[int, ...] | tuple[tuple[int, ...], bytes], Layout]:
        """Of the harmonics' components, and of what is free among them."""
        return {}

    def _layout(self, wave: Wave) -> Layout:
        key = wave.components
        if key not in self._layouts:
            self._layouts[key] = layout_of(self.couplings.pattern, key, self.space.count)
        return self._layouts[key]

    def _blocks(self, wave: Wave) -> np.ndarray:
        return wave.around * self.couplings.blocks(wave.n, wave.components)

    def stiffness(self, wave: Wave) -> csc_matrix:
        """Stiffness matrix (3·count, 3·count) of a harmonic, whole circle, before any support.

        Components that the harmonic does not have are left empty.
        """
        return self._layout(wave).matrix(self._blocks(wave))

    def supported(self, wave: Wave, free: np.ndarray) -> csc_matrix:
        """Rows and columns of the stiffness matrix that belong to free unknowns (mask)."""
        key = wave.components, free.tobytes()
        if key not in self._layouts:
            self._layouts[key] = self._layout(wave).among(free)
        return self._layouts[key].matrix(self._blocks(wave))

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
        free, u = self.prescribed(wave, fixed)
        inside = self.supported(wave, free)
        matrix = self.stiffness(wave) if u.any() else None  # of use where something is moved
        right = (load if matrix is None else load - matrix @ u)[free]
        try:
            u[free] = solved(inside, right)
        except RuntimeError as fault:  # SuperLU's word for an exactly singular matrix
            raise HarmonicError(f"harmonic {wave.n}: {fault}; is the body held?") from fault
        inner = inside @ u[free]
        twice_energy = float(u[free] @ inner if matrix is None else u @ (matrix @ u))
        lost = abs(float(u[free] @ (inner - right)))
        if not lost < LOST_ENERGY_LIMIT * twice_energy:
            raise HarmonicError(
                f"harmonic {wave.n}: {lost / max(twice_energy, 1e-300):.1e} of the energy is lost in "
                f"the solve, allowed {LOST_ENERGY_LIMIT:.0e}; is the body held?"
            )
        residual = relative_residual(inside, u[free], right)
        return Amplitudes(u, twice_energy, float(u @ load), residual, len(right))

    def prescribed(self, wave: Wave, fixed: list[Fixed]) -> tuple[np.ndarray, np.ndarray]:
        """Mask of the free unknowns, and all unknowns with the values prescribed, else 0."""
        count = self.space.count
        axis = np.flatnonzero(self.space.places[:, 0] < SAME)
        if wave.n == 1 and len(axis):
            raise HarmonicError("harmonic 1 of a body with an axis is not provided for")
        mask, value = np.zeros((count, 3), bool), np.zeros((count, 3))
        idle = [Fixed(np.arange(count), c) for c in wave.idle]
        for f in [*fixed, *idle, *(Fixed(axis, c) for c in wave.zero_on_axis)]:
            mask[f.numbers, f.component] = True
            value[f.numbers, f.component] = f.value
        return ~mask.ravel(), value.ravel()

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
