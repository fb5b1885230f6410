"""A solved harmonic of a body of revolution with its stresses, as other packages use it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.fea.axisymmetric.recovery import mises_parts
from flexspline.fea.types import StressPeak


@dataclass(frozen=True)
class StressLevel:
    """One mesh of the sequence and its peak."""

    elements: int
    unknowns: int
    mises_MPa: float
    energy_error: float
    """Estimated relative error of the strain energy."""


@dataclass(frozen=True)
class RevolvedField:
    """A solved harmonic on the finest mesh, its peak stress and how it got there.

    u_r = U cos nφ, u_θ = V sin nφ, u_z = W cos nφ; torsion is n = 0 with V alone. Stresses rr, θθ,
    zz and rz vary as cos nφ, rθ and θz as sin nφ (torsion: constant).

    Attributes
    ----------
    places : (count, 2) P2 nodes (r, z) [mm].
    triangles : (m, 6) their numbers: corners, then the middles of 01, 12, 02; any sense.
    displacement : (count, 3) amplitudes U, V, W [mm].
    stress : (count, 6) smoothed amplitudes rr, θθ, zz, rz, rθ, θz [MPa].
    peak : the largest von Mises stress that counts, its Cartesian place at the first of the angles with it.
    peak_rz : the same place on the meridian [mm].
    levels : the meshes.
    """

    n: int
    places: np.ndarray
    triangles: np.ndarray
    displacement: np.ndarray
    stress: np.ndarray
    peak: StressPeak
    peak_rz: tuple[float, float]
    levels: tuple[StressLevel, ...]

    def mises(self, phi: float) -> np.ndarray:
        """Return the von Mises stress (count,) at the nodes at an angle [MPa]."""
        direct, shear = mises_parts(dict(enumerate(self.stress.T)))
        if self.n == 0:
            return np.sqrt(direct + shear)
        return np.sqrt(direct * np.cos(self.n * phi) ** 2 + shear * np.sin(self.n * phi) ** 2)
