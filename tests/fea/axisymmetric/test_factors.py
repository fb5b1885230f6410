"""One solver for matrices in turn: the ordering is kept where it may be, and only there.

Small matrices are ordered when their places come a second time.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.sparse import csr_matrix, diags, eye_array, kron

from flexspline.fea.axisymmetric import factors
from flexspline.fea.axisymmetric.factors import PARDISO_AT_ONCE_FROM, PatternSolver, solved
from flexspline.fea.errors import SolveError
from flexspline.fea.pardiso import PardisoFactors, pardiso

WIDTH, WIDER = 25, 40

needs_mkl = pytest.mark.skipif(pardiso() is None, reason="MKL has no wheel for this machine")


def grid(weight: float, height: int = WIDTH, width: int = WIDTH) -> csr_matrix:
    """Of springs in a grid, those of one direction `weight` times as stiff, all nodes held by springs too."""
    chain = [diags([-1.0, 2.1, -1.0], [-1, 0, 1], shape=(n, n)) for n in (width, height)]
    both = kron(chain[0], eye_array(height)) + weight * kron(eye_array(width), chain[1])
    return csr_matrix(both)


@pytest.fixture
def orderings(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Unknowns of every matrix that was ordered."""
    made: list[int] = []

    class Seen(PardisoFactors):
        def __init__(self, matrix: csr_matrix, single: bool, plane: bool = False) -> None:
            assert plane
            made.append(matrix.shape[0])
            super().__init__(matrix, single, plane)

    monkeypatch.setattr(factors, "PardisoFactors", Seen)
    return made


@needs_mkl
@pytest.mark.parametrize("width", [WIDTH, WIDER])
def test_matrices_with_the_same_places_are_ordered_once(orderings: list[int], width: int) -> None:
    solver = PatternSolver()
    for number, weight in enumerate((1.0, 7.0, 0.3)):
        matrix = grid(weight, width, width)
        x = np.arange(matrix.shape[0]) % 11.0
        # the condition number is below 1e2, rounding 1e-16
        assert solver.solve(matrix, matrix @ x) == pytest.approx(x, abs=1e-12)
        large = width**2 >= PARDISO_AT_ONCE_FROM
        assert len(orderings) == (1 if large or number else 0)


@needs_mkl
def test_other_places_are_ordered_anew(orderings: list[int]) -> None:
    solver = PatternSolver()
    for height in (WIDER, WIDER - 1, WIDER):
        matrix = grid(2.0, height, WIDER)
        x = np.cos(np.arange(matrix.shape[0]))
        assert solver.solve(matrix, matrix @ x) == pytest.approx(x, abs=1e-12)
    assert orderings == [WIDER**2, WIDER * (WIDER - 1), WIDER**2]


@needs_mkl
def test_small_ones_with_other_places_each_are_not_ordered(orderings: list[int]) -> None:
    solver = PatternSolver()
    for height in (WIDTH, WIDTH - 1, WIDTH):
        matrix = grid(2.0, height)
        x = np.cos(np.arange(matrix.shape[0]))
        assert solver.solve(matrix, matrix @ x) == pytest.approx(x, abs=1e-12)
    assert not orderings


@needs_mkl
def test_as_many_unknowns_and_entries_at_other_places_are_no_second_time(
    orderings: list[int],
) -> None:
    solver, matrix = PatternSolver(), grid(2.0)
    order = np.random.default_rng(0).permutation(matrix.shape[0])
    other = csr_matrix(matrix[order][:, order])
    assert other.nnz == matrix.nnz
    x = np.cos(np.arange(matrix.shape[0]))
    for one in (matrix, other):
        assert solver.solve(one, one @ x) == pytest.approx(x, abs=1e-12)
    assert not orderings


@pytest.mark.parametrize("n", [20, 40])  # 400 unknowns are SuperLU's, 1 600 Pardiso's
@pytest.mark.parametrize("weight", [0.3, 1.7])
def test_a_singular_matrix_that_comes_first_is_found_out(weight: float, n: int) -> None:
    """A grid of springs held nowhere: rounding leaves a last pivot that is not 0."""
    chain = diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n)).tolil()
    chain[0, 0] = chain[-1, -1] = 1.0
    free = 0.1 * kron(chain, eye_array(n)) + weight * kron(eye_array(n), chain)
    load = np.random.default_rng(0).standard_normal(n * n)
    assert np.isfinite(solved(csr_matrix(free), load)).all()
    with pytest.raises(SolveError, match="unsupported"):
        PatternSolver().solve(csr_matrix(free), load)


def test_many_loads_at_once() -> None:
    matrix = grid(3.0)
    x = np.random.default_rng(0).standard_normal((matrix.shape[0], 5))
    assert PatternSolver().solve(matrix, matrix @ x) == pytest.approx(x, abs=1e-11)
    assert PatternSolver().solve(matrix, matrix @ x) == pytest.approx(
        solved(matrix, matrix @ x), abs=1e-11
    )


def test_threads_share_a_solver() -> None:
    solver = PatternSolver()
    x = np.cos(np.arange(WIDTH**2))

    def off(weight: float) -> float:
        matrix = grid(weight)
        return float(np.abs(solver.solve(matrix, matrix @ x) - x).max())

    with ThreadPoolExecutor(4) as pool:
        # what one thread solves with another's factors is off by the whole of it
        assert max(pool.map(off, np.linspace(1.0, 9.0, 24))) < 1e-12


@needs_mkl
def test_after_a_singular_matrix_the_next_is_solved() -> None:
    solver = PatternSolver()
    matrix = grid(1.0)
    for _ in range(2):  # the second time Pardiso's
        solver.solve(matrix, np.ones(matrix.shape[0]))
    wrong = matrix - 3.0 * eye_array(matrix.shape[0])
    with pytest.raises(SolveError, match="unsupported"):
        solver.solve(csr_matrix(wrong), np.ones(matrix.shape[0]))
    x = np.cos(np.arange(matrix.shape[0]))
    assert solver.solve(matrix, matrix @ x) == pytest.approx(x, abs=1e-12)
