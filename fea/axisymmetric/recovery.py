"""Stress amplitudes of a harmonic, recovered at the nodes, and the error estimate of this recovery.

The estimate is Zienkiewicz and Zhu's (Int. J. Numer. Meth. Eng. 24, 1987, 337-357).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from flexspline.fea.axisymmetric.harmonics import Harmonic, HarmonicModel
from flexspline.fea.cylindrical import AXIAL, RADIAL, TANGENTIAL
from flexspline.fea.nodal_average import nodal_average
from flexspline.fea.types import Elastic

RR, THETA_THETA, ZZ, RZ, R_THETA, THETA_Z = range(6)
"""Index of a stress component."""
DIRECT = (RR, THETA_THETA, ZZ)
"""The normal stresses, whose sum is the trace; a shear stress counts twice in the energy."""
Parts = Mapping[int, np.ndarray]
"""Stresses by their number, those that are not 0: the first four vary as cos nφ, the others as sin nφ."""


@dataclass(frozen=True)
class Recovered:
    """A harmonic's stresses (rr, θθ, zz, rz × cos nφ; rθ, θz × sin nφ) and error estimate.

    Attributes
    ----------
    nodal : (count, 6) smoothed amplitudes at the P2 nodes [MPa].
    raw, misfit : stresses, and smoothed less raw ones, at the quadrature points (m, q) [MPa].
    volume : of those points, whole circle [mm³].
    """

    nodal: np.ndarray
    raw: Parts
    misfit: Parts
    volume: np.ndarray
    material: Elastic

    @cached_property
    def energy(self) -> np.ndarray:
        """∫σ:C⁻¹:σ of each triangle (m,) over the whole circle [N·mm]."""
        return self._twice_energy(self.raw)

    @cached_property
    def error(self) -> np.ndarray:
        """The same integral (m,) of smoothed less raw stress [N·mm]."""
        return self._twice_energy(self.misfit)

    @cached_property
    def largest_misfit(self) -> np.ndarray:
        """Largest von Mises stress of smoothed less raw stress in each triangle (m,) [MPa]."""
        return np.sqrt(np.maximum(*mises_parts(self.misfit)).max(axis=1))

    def _twice_energy(self, stress: Parts) -> np.ndarray:
        return np.asarray((self.volume * _twice_density(stress, self.material)).sum(axis=1))


def recovered(model: HarmonicModel, wave: Harmonic, displacement: np.ndarray) -> Recovered:
    """Smooth the stresses of solved amplitudes (3·count,)."""
    s, material = model.space, model.material
    raw = stress(wave, material, s.basis, displacement)
    at_nodes = stress(wave, material, model.nodal_basis, displacement)
    weight = (s.weights * s.r).sum(axis=1)
    local = np.stack(list(at_nodes.values()), axis=2)
    nodal = np.zeros((s.count, 6))
    nodal[:, list(at_nodes)] = nodal_average(s.count, len(at_nodes), [(s.dofs, weight, local)])
    misfit = {k: s.values(nodal[:, k]) - part for k, part in raw.items()}
    return Recovered(nodal, raw, misfit, wave.around * s.weights * s.r, material)


def stress(wave: Harmonic, material: Elastic, basis: Any, displacement: np.ndarray) -> Parts:
    """Return amplitudes (m, q) [MPa] of the harmonic's stresses from U, V, W (3·count,) [mm]."""
    r = np.asarray(basis.global_coordinates())[0]
    amplitude = displacement.reshape(-1, 3).T
    fields = {component: basis.interpolate(amplitude[component]) for component in wave.components}
    return stress_of(wave, material, r, fields)


def stress_of(wave: Harmonic, material: Elastic, r: np.ndarray, fields: Mapping[int, Any]) -> Parts:
    """Return stress amplitudes [MPa] at radii r [mm] from scikit-fem's fields U, V, W [mm] there."""
    lam, mu, n = material.lam, material.mu, wave.n
    if wave.torsion:
        v = fields[TANGENTIAL]
        v_r, v_z = v.grad
        return {R_THETA: mu * (v_r - v / r), THETA_Z: mu * v_z}
    u, w = fields[RADIAL], fields[AXIAL]
    (u_r, u_z), (w_r, w_z) = u.grad, w.grad
    around = (u + n * fields[TANGENTIAL]) / r if n else u / r
    mean = lam * (u_r + around + w_z)
    parts = {
        RR: mean + 2 * mu * u_r,
        THETA_THETA: mean + 2 * mu * around,
        ZZ: mean + 2 * mu * w_z,
        RZ: mu * (u_z + w_r),
    }
    if n:
        v = fields[TANGENTIAL]
        v_r, v_z = v.grad
        parts |= {R_THETA: mu * (v_r - (v + n * u) / r), THETA_Z: mu * (v_z - n * w / r)}
    return parts


def _twice_density(stress: Parts, material: Elastic) -> np.ndarray:
    """σ:C⁻¹:σ of amplitudes; cos² and sin² have the same mean."""
    lam, mu = material.lam, material.mu
    twice = sum((1 if k in DIRECT else 2) * part**2 for k, part in stress.items())
    trace = sum((stress[k] for k in DIRECT if k in stress), np.zeros(1))
    return (twice - lam / (3 * lam + 2 * mu) * trace**2) / (2 * mu)


def mises_parts(stress: Parts) -> tuple[np.ndarray, np.ndarray]:
    """Return A, B [MPa²] of the squared von Mises stress A cos² nφ + B sin² nφ; absent stresses are 0."""
    none = np.zeros_like(next(iter(stress.values())))
    rr, tt, zz, rz, rt, tz = (stress.get(k, none) for k in range(6))
    direct = ((rr - tt) ** 2 + (tt - zz) ** 2 + (zz - rr) ** 2) / 2 + 3 * rz**2
    return direct, 3 * (rt**2 + tz**2)
