"""A solid model and its supports: prescribed cylindrical components (radial, tangential, axial) of nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix

from flexspline.fea.cylindrical import AXIAL, RADIAL, TANGENTIAL
from flexspline.fea.solid.assembly import NodeFrames, stiffness_matrix
from flexspline.fea.solid.flatness import mostly_flat
from flexspline.fea.solid.memory import SolverKind, check_before_assembly
from flexspline.fea.solid.solver import Case, Solution, solve_each
from flexspline.fea.solid.space import SolidSpace
from flexspline.fea.solid.twolevel import corner_interpolation
from flexspline.fea.types import Elastic, TetMesh
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START

PLANES = (SYMMETRY_START, SYMMETRY_END)


@dataclass(frozen=True)
class Model:
    """A mesh with its assembled stiffness matrix, shared by all load cases on it."""

    mesh: TetMesh
    material: Elastic
    frames: NodeFrames
    matrix: csr_matrix
    space: SolidSpace
    """Its patches as scikit-fem's boundaries."""
    solve_by: SolverKind | None = None
    """How to solve; by unknowns and memory when absent."""

    @cached_property
    def is_flat(self) -> bool:
        """Whether so many elements are flat that an iteration is slow."""
        return mostly_flat(self.mesh)

    @classmethod
    def of(cls, mesh: TetMesh, material: Elastic) -> Model:
        """Assemble the stiffness matrix; raises MemoryShortError if it or the solve would not fit."""
        check_before_assembly(3 * len(mesh.nodes))
        return cls.in_frames(mesh, material, NodeFrames.cylindrical(mesh.nodes))

    @classmethod
    def in_frames(cls, mesh: TetMesh, material: Elastic, frames: NodeFrames) -> Model:
        """Assemble with components along the axes given at each node."""
        space = SolidSpace.of(mesh)
        return cls(mesh, material, frames, stiffness_matrix(space, material, frames), space)

    def on(self, patch: str) -> np.ndarray:
        """Return the sorted nodes on a patch, its edges included."""
        return self.space.on(patch)

    @property
    def copies(self) -> float:
        return 360.0 / self.mesh.sector_deg


class Supports:
    """Prescribed components (n, 3): whether by `mask`, and by `value` [mm]; what is set later wins."""

    def __init__(self, model: Model) -> None:
        n = len(model.mesh.nodes)
        self.mask = np.zeros((n, 3), bool)
        self.value = np.zeros((n, 3))
        self._model = model

    def set(self, nodes: np.ndarray, component: int, value: np.ndarray | float = 0.0) -> None:
        self.mask[nodes, component] = True
        self.value[nodes, component] = value

    def symmetry(self, antisymmetric: bool, planes: tuple[str, ...] = PLANES) -> None:
        # the axis lies in both planes: what is normal to one lies in the other; a half has but one plane
        two_planes = self._model.mesh.sector_deg != 180
        for patch in planes:
            nodes = self._model.on(patch)
            axis = nodes[self._model.frames.radius[nodes] == 0]
            if antisymmetric:
                self.set(nodes, RADIAL)
                self.set(nodes, AXIAL)
                if two_planes:
                    self.set(axis, TANGENTIAL)
            else:
                self.set(nodes, TANGENTIAL)
                if two_planes:
                    self.set(axis, RADIAL)

    def hold(self, patch: str) -> None:
        nodes = self._model.on(patch)
        for component in (RADIAL, TANGENTIAL, AXIAL):
            self.set(nodes, component)

    def solve(self, load: np.ndarray) -> Solution:
        """Solve under nodal forces `load` (N,) [N]; errors as of `solver.solve_each`."""
        (solution,) = self._solve((load,), (1.0,))
        return solution

    def solve_also_at_rest(
        self, load: np.ndarray, at_rest: np.ndarray
    ) -> tuple[Solution, Solution]:
        """Solve, and solve under other forces with all that is prescribed 0, by the same factors."""
        turned, rested = self._solve((load, at_rest), (1.0, 0.0))
        return turned, rested

    def solve_at_rest(self, load: np.ndarray) -> Solution:
        """Solve with all that is prescribed 0."""
        (solution,) = self._solve((load,), (0.0,))
        return solution

    def _solve(self, loads: Sequence[np.ndarray], times: Sequence[float]) -> list[Solution]:
        fixed = np.flatnonzero(self.mask.ravel())
        model, value = self._model, self.value.ravel()[fixed]
        return solve_each(
            model.matrix,
            [Case(load, factor * value) for load, factor in zip(loads, times, strict=True)],
            fixed,
            lambda: corner_interpolation(model.mesh, model.frames),
            model.solve_by,
            model.is_flat,
        )
