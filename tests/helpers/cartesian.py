"""Solid models in Cartesian components with loads spread consistently over nodes, for benchmarks.

Any consistent units will do: the solver's mm and MPa are names only here.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from skfem import LinearForm

from flexspline.fea.solid.assembly import NodeFrames
from flexspline.fea.solid.elements import (
    basis_of,
    reference_values,
    tet_rule,
)
from flexspline.fea.solid.model import Model, Supports
from flexspline.fea.solid.space import SolidSpace
from flexspline.fea.types import Elastic, TetMesh

X, Y, Z = 0, 1, 2
FORCES = LinearForm(lambda v, w: w.traction * v)
Traction = Callable[[np.ndarray], np.ndarray]


def at(component: int, value: float) -> Callable[[np.ndarray], np.ndarray]:
    """The box face where a coordinate has a value."""
    return lambda c: np.isclose(c[:, component], value)


def cartesian_model(mesh: TetMesh, material: Elastic) -> Model:
    """A model whose supports hold x, y, z components."""
    n = len(mesh.nodes)
    frames = NodeFrames(np.tile(np.eye(3), (n, 1, 1)), np.zeros(n))
    return Model.in_frames(mesh, material, frames)


def surface_load(mesh: TetMesh, patch: str, traction: Traction) -> np.ndarray:
    """Nodal forces (n, 3) of a traction given at points (..., 3) as vectors (..., 3)."""
    space = SolidSpace.of(mesh)
    basis = space.facet_basis(patch, degree=6)
    at = np.asarray(basis.global_coordinates())
    forces = traction(np.moveaxis(at, 0, -1))
    load = np.zeros_like(mesh.nodes)
    for component in (X, Y, Z):
        of_one = FORCES.assemble(basis, traction=np.ascontiguousarray(forces[..., component]))
        load[space.node, component] = of_one
    return load


def body_load(mesh: TetMesh, force: np.ndarray) -> np.ndarray:
    """Nodal forces (n, 3) of a constant force (3,) per volume."""
    weights = basis_of(mesh.curved.mesh).dx
    shares = np.einsum("mq,qi->mi", weights, reference_values(tet_rule()[0]))
    load = np.zeros_like(mesh.nodes)
    np.add.at(load, mesh.cells, shares[..., None] * force)
    return load


def displacement(supports: Supports, load: np.ndarray) -> np.ndarray:
    """Displacement (n, 3) under nodal forces (n, 3)."""
    return supports.solve(load.ravel()).unknowns.reshape(-1, 3)


def through_thickness(values: np.ndarray) -> float:
    """Mean of nodal values (2k + 1,) in order through k quadratic elements (Simpson)."""
    weights = np.ones(len(values))
    weights[1::2], weights[2:-1:2] = 4, 2
    return float(weights @ values / weights.sum())
