"""Bounds of a shaft's K from one mesh."""

from __future__ import annotations

from flexspline.fea.solid.load_cases import torsion
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.types import Elastic, TetMesh


def one_mesh_bounds(mesh: TetMesh, material: Elastic) -> tuple[float, float]:
    """Lower and upper [N·m/rad] of a shaft turned at its grip.

    K_h is above K; the estimate times 4 is the lower end that `solid_stiffness` states for one mesh.
    """
    solved = torsion(Model.of(mesh, material), "grip")
    error = energy_error(mesh, solved.displacement, material).relative
    return solved.K_energy * (1 - 4 * error), solved.K_energy
