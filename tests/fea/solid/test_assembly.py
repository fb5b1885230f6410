"""The batched assembly against scikit-fem's own, and the mesh bookkeeping around it."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from structured import sector_mesh

from flexspline.fea.errors import SolveError
from flexspline.fea.solid.assembly import NodeFrames, stiffness_matrix
from flexspline.fea.solid.elements import NODES, reference_values
from flexspline.fea.solid.load_cases import torsion
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.solver import Case, solve
from flexspline.fea.solid.space import SolidSpace
from flexspline.fea.solid.unfold import folded, unfolded
from flexspline.fea.types import Elastic

STEEL = Elastic(206e3, 0.3)


def small():
    return sector_mesh(
        np.linspace(8, 10, 3), np.linspace(0, pi / 6, 4), np.linspace(0, 4, 3),
        {"mount": lambda c: np.isclose(c[:, 2], 0), "mesh": lambda c: np.isclose(c[:, 2], 4)},
        shake=0.2,
    )  # fmt: skip


def test_nodes_are_where_the_basis_says() -> None:
    assert reference_values(NODES) == pytest.approx(np.eye(10), abs=1e-14)


def test_matrix_equals_scikit_fems_on_curved_elements() -> None:
    from skfem import Basis, BilinearForm, ElementTetP2, ElementVector
    from skfem.helpers import ddot, sym_grad, trace

    mesh = small()
    eye = np.zeros((len(mesh.nodes), 3, 3)) + np.eye(3)
    ours = stiffness_matrix(SolidSpace.of(mesh), STEEL, NodeFrames(eye, np.zeros(len(mesh.nodes))))
    basis = Basis(mesh.curved.mesh, ElementVector(ElementTetP2()), intorder=4)

    @BilinearForm
    def elasticity(u, v, _):
        strain = sym_grad(u)
        return 2 * STEEL.mu * ddot(strain, sym_grad(v)) + STEEL.lam * trace(strain) * trace(
            sym_grad(v)
        )

    theirs = elasticity.assemble(basis)
    # scikit-fem numbers corners' unknowns first, then edges', each node's three in a row: as we do
    assert abs(ours - theirs).max() < 1e-12 * abs(theirs).max()


def test_unfolding_by_reflection_keeps_the_stiffness() -> None:
    mesh = small()
    sector = torsion(Model.of(mesh, STEEL), "mesh").K_energy
    for times in (2, 3):
        larger = unfolded(mesh, times * 30.0)
        assert len(larger.cells) == times * len(mesh.cells)
        assert torsion(Model.of(larger, STEEL), "mesh").K_energy == pytest.approx(sector, rel=1e-10)


def test_folding_takes_unfolded_nodes_back() -> None:
    mesh = small()
    back = folded(unfolded(mesh, 90.0).nodes, 30.0)
    away = np.linalg.norm(back[:, None] - mesh.nodes[None], axis=2).min(axis=1)
    assert away.max() < 1e-12 * 10


def test_unfolding_refuses_a_sector_that_does_not_fit() -> None:
    with pytest.raises(ValueError, match="not a multiple"):
        unfolded(small(), 100.0)


def test_an_unsupported_body_is_refused_with_a_reason() -> None:
    mesh = small()
    model = Model.of(mesh, STEEL)
    load = np.zeros(model.matrix.shape[0])
    load[2] = 1.0
    none = np.empty(0, int)
    with pytest.raises(SolveError, match="may be unsupported"):
        solve(model.matrix, Case(load, np.empty(0)), none)


def test_superlu_stands_in_for_pardiso(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = small()
    with_mkl = torsion(Model.of(mesh, STEEL), "mesh").K_energy
    monkeypatch.setattr("flexspline.fea.solid.direct.pardiso", lambda: None)
    without = torsion(Model.of(mesh, STEEL), "mesh").K_energy
    assert without == pytest.approx(with_mkl, rel=1e-10)
