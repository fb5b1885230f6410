"""Stresses of a solved model: at nodes, as von Mises, and the recovery estimate of the energy error.

The estimator is Zienkiewicz and Zhu's (1987): stresses averaged at the nodes against the raw ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from flexspline.fea.solid.elements import (
    NODES,
    basis_of,
    displacement_gradient,
    quadratic_mesh,
    reference_values,
)
from flexspline.fea.types import Elastic, TetMesh


def _stress(basis: Any, u_cells: np.ndarray, material: Elastic) -> np.ndarray:
    """Cauchy stress (m, q, 3, 3) MPa from cell displacements (m, 10, 3) Cartesian, mm."""
    grad = displacement_gradient(basis, u_cells)
    strain = 0.5 * (grad + grad.swapaxes(2, 3))
    trace = np.trace(strain, axis1=2, axis2=3)
    return 2 * material.mu * strain + material.lam * trace[..., None, None] * np.eye(3)


def nodal_stress(mesh: TetMesh, u: np.ndarray, material: Elastic) -> np.ndarray:
    """Stress (n, 3, 3) MPa at the nodes: element values there, averaged by volume.

    `u` is (n, 3) Cartesian, mm.
    """
    at_nodes = NODES, np.ones(len(NODES)) / len(NODES)
    basis = basis_of(quadratic_mesh(mesh.nodes, mesh.cells), quadrature=at_nodes)
    local = _stress(basis, u[mesh.cells], material).reshape(-1, 9)
    weight = np.repeat(basis.dx.sum(axis=1), 10)
    nodes = mesh.cells.ravel()
    n = len(mesh.nodes)
    total = np.bincount(nodes, weight, minlength=n)
    summed = [np.bincount(nodes, weight * local[:, k], minlength=n) for k in range(9)]
    return (np.stack(summed, axis=1) / total[:, None]).reshape(n, 3, 3)


def von_mises(stress: np.ndarray) -> np.ndarray:
    """√(3/2 s:s), s the deviator, of stresses (..., 3, 3)."""
    trace = np.trace(stress, axis1=-2, axis2=-1)
    s = stress - trace[..., None, None] * np.eye(3) / 3
    return np.sqrt(1.5 * np.einsum("...ij,...ij->...", s, s))


@dataclass(frozen=True)
class EnergyErrorEstimate:
    """Twice the strain energy ∫σ:ε and the estimated squared error of it, per element (m,) N·mm."""

    energy: np.ndarray
    error: np.ndarray

    @property
    def relative(self) -> float:
        """Estimated relative error of the energy, and so of a stiffness."""
        return float(self.error.sum() / self.energy.sum())


def energy_error(mesh: TetMesh, u: np.ndarray, material: Elastic) -> EnergyErrorEstimate:
    """Recovery estimate of ∫(σ − σh):C⁻¹:(σ − σh) per element."""
    basis = basis_of(quadratic_mesh(mesh.nodes, mesh.cells))
    raw = _stress(basis, u[mesh.cells], material)
    nodal = nodal_stress(mesh, u, material).reshape(-1, 9)
    smooth = np.matmul(reference_values(basis.X.T)[None], nodal[mesh.cells]).reshape(raw.shape)
    return EnergyErrorEstimate(
        np.einsum("mq,mq->m", _twice_energy(raw, material), basis.dx),
        np.einsum("mq,mq->m", _twice_energy(smooth - raw, material), basis.dx),
    )


def _twice_energy(stress: np.ndarray, material: Elastic) -> np.ndarray:
    """σ:C⁻¹:σ = ((1 + ν) σ:σ − ν tr²σ)/E [MPa]."""
    nu = material.poissons_ratio
    trace = np.trace(stress, axis1=-2, axis2=-1)
    square = np.einsum("...ij,...ij->...", stress, stress)
    return ((1 + nu) * square - nu * trace**2) / material.youngs_modulus_MPa
