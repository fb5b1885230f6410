"""Factors that one thread makes and another uses, with other numbers of threads of oneMKL."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_matrix, diags, eye_array, kron
from threadpoolctl import threadpool_limits

from flexspline.fea import pardiso as module
from flexspline.fea.mkl import mkl
from flexspline.fea.pardiso import SMALL_SOLID, PardisoFactors, pardiso

pytestmark = pytest.mark.skipif(pardiso() is None, reason="MKL has no wheel for this machine")

SIDE = 26
"""Grid points along an edge: more unknowns than SMALL_SOLID, where factors are made by one thread."""


def block(side: int = SIDE) -> csr_matrix:
    """Springs between neighbours of a grid, each point held by one of a tenth."""
    chain = diags([-1.0, 2.1, -1.0], [-1, 0, 1], shape=(side, side))
    one = eye_array(side)
    along = (kron(kron(chain, one), one), kron(kron(one, chain), one), kron(kron(one, one), chain))
    return csr_matrix(kron(sum(along), np.diag([1.0, 2.0, 3.0])))


@pytest.mark.parametrize(
    ("making", "solving"), [(1, 2), pytest.param(2, 1, marks=pytest.mark.long)]
)
def test_the_number_of_threads_may_change_between_factors_and_solve(
    making: int, solving: int
) -> None:
    matrix = block()
    true = np.random.default_rng(1).standard_normal(matrix.shape[0])
    with threadpool_limits(making, "blas"):
        factors = PardisoFactors(matrix, single=False)
        again = PardisoFactors(matrix, single=False)
    with threadpool_limits(solving, "blas"):
        # a condition number of 4e1
        assert factors.solve(matrix @ true) == pytest.approx(true, abs=1e-12)
        assert again.replace(2 * matrix)
        assert again.solve(matrix @ true) == pytest.approx(true / 2, abs=1e-12)
    factors.release()
    again.release()


def test_the_thread_that_calls_keeps_its_own_number() -> None:
    with threadpool_limits(1, "blas"):
        factors = PardisoFactors(block(), single=False)
    with threadpool_limits(2, "blas"):
        before = mkl().MKL_Get_Max_Threads()
        factors.solve(np.ones(3 * SIDE**3))
        assert mkl().MKL_Get_Max_Threads() == before


class SeenLibrary:
    """oneMKL, and every number of threads it was asked to use."""

    def __init__(self) -> None:
        self.asked: list[int] = []

    def MKL_Set_Num_Threads_Local(self, count: int) -> int:
        self.asked.append(count)
        return int(mkl().MKL_Set_Num_Threads_Local(count))

    def MKL_Get_Max_Threads(self) -> int:
        return int(mkl().MKL_Get_Max_Threads())


@pytest.mark.parametrize(
    ("plane", "side", "threads"), [(True, SIDE, 1), (False, SIDE, 2), (False, SIDE - 1, 1)]
)
def test_plane_and_small_solid_meshes_are_solved_by_one_thread(
    plane: bool, side: int, threads: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever the machine offers: with two in each of two processes on two cores, `stiffness` took five
    times as long."""
    seen = SeenLibrary()
    monkeypatch.setattr(module, "mkl", lambda: seen)
    matrix = block(side)
    assert (matrix.shape[0] > SMALL_SOLID) is (side == SIDE)
    with threadpool_limits(2, "blas"):
        factors = PardisoFactors(matrix, single=False, plane=plane)
        factors.solve(np.ones(matrix.shape[0]))
        factors.release()
    assert (
        seen.asked[::2] == [threads] * 3
    )  # factors, substitution, release; each then sets it back
