"""Results of a solid model's load case: a field, with K or with the change of K by cuts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.fea.solid.memory import SolverKind
from flexspline.fea.types import MeshLevel, TetMesh


@dataclass(frozen=True)
class Solved:
    """A solved case: displacement (n, 3) Cartesian mm."""

    mesh: TetMesh
    displacement: np.ndarray
    residual: float
    dofs: int
    solver: SolverKind


@dataclass(frozen=True)
class SolvedStiffness(Solved):
    """A solved case that defines a stiffness of the whole part.

    Attributes
    ----------
    K_energy : from the strain energy [N·m/rad].
    K_check : the same from the reaction's torque, or from the work of the loads [N·m/rad].
    """

    K_energy: float
    K_check: float

    @property
    def level(self) -> MeshLevel:
        """The mesh and its K."""
        return _level(self.mesh, self.dofs, self.K_energy, self.K_check, self.residual)


@dataclass(frozen=True)
class SolvedCorrection:
    """v_h of `fea.solid.superposition`, (n, 3) Cartesian mm.

    Attributes
    ----------
    lost : E + a(v_h, v_h) of the whole part [N·mm].
    lost_by_work : the same with the work of the forces in place of the energy.
    doubt : how far that moves, to first order, from u₀ on the coarser mesh at the cuts.
    unknowns : of all waves together. residual : relative, of the worst solve.
    """

    mesh: TetMesh
    displacement: np.ndarray
    lost: float
    lost_by_work: float
    doubt: float
    unknowns: int
    residual: float

    def level(self, K_Nm_per_rad: float, check_Nm_per_rad: float) -> MeshLevel:
        """Return the mesh, its K, and K by the work."""
        return _level(self.mesh, self.unknowns, K_Nm_per_rad, check_Nm_per_rad, self.residual)


def _level(
    mesh: TetMesh, unknowns: int, K_Nm_per_rad: float, check_Nm_per_rad: float, residual: float
) -> MeshLevel:
    return MeshLevel(
        mesh.shortest_edge_mm, mesh.elements, unknowns, K_Nm_per_rad, check_Nm_per_rad, residual
    )
