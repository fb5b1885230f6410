"""Stresses of a solved model: at nodes, as von Mises, and the recovery estimate of the energy error.

The estimator is Zienkiewicz and Zhu's (1987): stresses averaged at the nodes against the raw ones.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from flexspline.fea.nodal_average import ElementValues, nodal_average
from flexspline.fea.solid.elements import (
    NODES,
    basis_of,
    displacement_gradient,
    reference_values,
)
from flexspline.fea.types import Elastic, TetMesh

STRESS_CHUNK_ELEMENTS = 2000
"""Elements at a time: their stresses at the quadrature points, 1.6 MB, stay in the processor's cache."""


def _stress(basis: Any, u_cells: np.ndarray, material: Elastic) -> np.ndarray:
    """Cauchy stress (m, q, 3, 3) MPa from cell displacements (m, 10, 3) Cartesian, mm."""
    grad = displacement_gradient(basis, u_cells)
    strain = 0.5 * (grad + grad.swapaxes(2, 3))
    trace = np.trace(strain, axis1=2, axis2=3)
    return 2 * material.mu * strain + material.lam * trace[..., None, None] * np.eye(3)


def nodal_stress(mesh: TetMesh, u: np.ndarray, material: Elastic) -> np.ndarray:
    """Return the stress (n, 3, 3) MPa at the nodes: element values there, averaged by volume.

    `u` is (n, 3) Cartesian, mm.
    """
    at_nodes = NODES, np.ones(len(NODES)) / len(NODES)

    def parts() -> Iterator[ElementValues]:
        for part in _parts(mesh.elements):
            basis, cells = basis_of(mesh.curved.mesh, part, at_nodes), mesh.cells[part]
            local = _stress(basis, u[cells], material)
            yield cells, basis.dx.sum(axis=1), local.reshape(*cells.shape, 9)

    return nodal_average(len(mesh.nodes), 9, parts()).reshape(-1, 3, 3)


def elements_beside(mesh: TetMesh, place: np.ndarray) -> np.ndarray:
    """Return the elements (k,) at the node nearest to a place (3,) [mm]."""
    node = np.linalg.norm(mesh.nodes - place, axis=1).argmin()
    return np.flatnonzero((mesh.cells == node).any(axis=1))


def misfit_beside(
    mesh: TetMesh, u: np.ndarray, material: Elastic, nodal: np.ndarray, place: np.ndarray
) -> float:
    """Return the largest von Mises stress [MPa] of raw less averaged stress, in the elements at one node.

    It is the node nearest to a place (3,) [mm]; `nodal` is `nodal_stress`.
    """
    beside = elements_beside(mesh, place)
    cells, at_nodes = mesh.cells[beside], (NODES, np.ones(len(NODES)) / len(NODES))
    basis = basis_of(mesh.curved.mesh, beside, at_nodes)
    return float(von_mises(_stress(basis, u[cells], material) - nodal[cells]).max())


def _parts(elements: int) -> Iterator[np.ndarray]:
    """The elements' numbers, STRESS_CHUNK_ELEMENTS at a time."""
    for start in range(0, elements, STRESS_CHUNK_ELEMENTS):
        yield np.arange(start, min(start + STRESS_CHUNK_ELEMENTS, elements))


def von_mises(stress: np.ndarray) -> np.ndarray:
    """Return √(3/2 s:s), s the deviator, of stresses (..., 3, 3)."""
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
    nodal = nodal_stress(mesh, u, material).reshape(-1, 9)
    energy, error = np.empty((2, mesh.elements))
    for part in _parts(mesh.elements):
        basis, cells = basis_of(mesh.curved.mesh, part), mesh.cells[part]
        raw = _stress(basis, u[cells], material)
        smooth = np.matmul(reference_values(basis.X.T), nodal[cells]).reshape(raw.shape)
        energy[part] = np.einsum("mq,mq->m", _twice_energy(raw, material), basis.dx)
        error[part] = np.einsum("mq,mq->m", _twice_energy(smooth - raw, material), basis.dx)
    return EnergyErrorEstimate(energy, error)


def _twice_energy(stress: np.ndarray, material: Elastic) -> np.ndarray:
    """σ:C⁻¹:σ = ((1 + ν) σ:σ − ν tr²σ)/E [MPa]."""
    nu = material.poissons_ratio
    trace = np.trace(stress, axis1=-2, axis2=-1)
    square = np.einsum("...ij,...ij->...", stress, stress)
    return ((1 + nu) * square - nu * trace**2) / material.youngs_modulus_MPa
