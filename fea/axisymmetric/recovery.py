"""Stress amplitudes of a harmonic, smoothed at the nodes, and what the smoothing says of the error.

The estimate is Zienkiewicz and Zhu's (Int. J. Numer. Meth. Eng. 24, 1987, 337-357).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.axisymmetric.harmonics import COSINE, HarmonicModel, Wave, elasticity
from fea.axisymmetric.space import mapped, reference_shape
from fea.types import Elastic

CORNERS_AND_MIDDLES = np.array([[0, 1, 0, 0.5, 0.5, 0], [0, 0, 1, 0, 0.5, 0.5]])
"""Nodes of the reference triangle in P2 order (2, 6)."""
INWARD = 1e-6
"""Stresses at nodes are taken this far inside, where u/r is defined even on the axis."""


@dataclass(frozen=True)
class Recovered:
    """A harmonic's stresses (rr, θθ, zz, rz × cos nφ; rθ, θz × sin nφ) and error estimate.

    Attributes
    ----------
    nodal : (count, 6) smoothed amplitudes at the P2 nodes [MPa].
    energy : (m,) ∫σ:C⁻¹:σ of each triangle, whole circle [N·mm].
    error : (m,) the same of smoothed less raw stress.
    misfit : (m,) largest von Mises stress of smoothed less raw stress in each triangle [MPa].
    """

    nodal: np.ndarray
    energy: np.ndarray
    error: np.ndarray
    misfit: np.ndarray


def recovered(model: HarmonicModel, wave: Wave, displacement: np.ndarray) -> Recovered:
    """Smooth the stresses of solved amplitudes (3·count,)."""
    s = model.space
    local = displacement[model.numbers][:, None, :, None]
    hooke = elasticity(model.material)

    def stress(values: np.ndarray, gradients: np.ndarray, r: np.ndarray) -> np.ndarray:
        strain = model.strain(wave.n, values, gradients, r) @ local
        return strain[..., 0] @ hooke

    raw = stress(s.values, s.gradients, s.r)
    inside = 1 / 3 + (1 - INWARD) * (CORNERS_AND_MIDDLES - 1 / 3)
    values, slopes = reference_shape(inside)
    gradients, _, rz = mapped(s.places[s.dofs], values, slopes)
    at_nodes = stress(values, gradients, rz[..., 0])
    weight = (s.weights * s.r).sum(axis=1)
    nodes, share = s.dofs.ravel(), np.repeat(weight, 6)
    sums = [np.bincount(nodes, share * at_nodes[..., k].ravel(), s.count) for k in range(6)]
    nodal = (np.stack(sums) / np.bincount(nodes, share, s.count)).T
    misfit = np.einsum("mic,iq->mqc", nodal[s.dofs], s.values) - raw
    volume = wave.around * s.weights * s.r
    return Recovered(
        nodal,
        (volume * _twice_density(raw, model.material)).sum(axis=1),
        (volume * _twice_density(misfit, model.material)).sum(axis=1),
        np.sqrt(_mises_squared(misfit).max(axis=1)),
    )


def _twice_density(stress: np.ndarray, material: Elastic) -> np.ndarray:
    """σ:C⁻¹:σ of amplitudes; cos² and sin² have the same mean."""
    compliance = np.linalg.inv(elasticity(material))
    return np.einsum("...a,ab,...b->...", stress, compliance, stress)


def _mises_squared(stress: np.ndarray) -> np.ndarray:
    parts = mises_parts(stress)
    return np.maximum(parts[0], parts[1])


def mises_parts(stress: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A, B [MPa²] of the squared von Mises stress A cos² nφ + B sin² nφ, stress (..., 6)."""
    rr, tt, zz, rz = np.moveaxis(stress[..., COSINE], -1, 0)
    direct = ((rr - tt) ** 2 + (tt - zz) ** 2 + (zz - rr) ** 2) / 2 + 3 * rz**2
    return direct, 3 * (stress[..., 4] ** 2 + stress[..., 5] ** 2)
