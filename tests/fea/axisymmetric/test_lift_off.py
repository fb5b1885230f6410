"""Forces that only push, against problems whose answer is known and against non-negative least squares."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import cholesky
from scipy.optimize import nnls

from flexspline.fea.axisymmetric.lift_off import SEAT_RESIDUAL, pushing

KINDS = ("mixed", "all touch", "all lifted", "neither", "just touching", "two places in one")


def problem(rng: np.random.Generator, kind: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Matrix, free gaps and the forces that answer them, as soft and as stiff as thin rims are.

    "neither": gaps that are closed without a force (p = u = 0), where complementarity is not strict.
    """
    n = int(rng.integers(1, 60))
    turned, _ = np.linalg.qr(rng.normal(size=(n, n)))
    softness = 10.0 ** rng.uniform(-4, 0, n)
    matrix = (turned * softness) @ turned.T
    if kind == "two places in one":
        twice = rng.integers(0, n, n + 3)
        matrix = matrix[np.ix_(twice, twice)] + 1e-9 * np.eye(n + 3)
        n += 3
    role = rng.random(n)
    touch = {"all touch": role >= 0, "all lifted": role < 0}.get(kind, role < 0.5)
    force = np.where(touch, rng.uniform(0.1, 1, n), 0.0)
    gap = np.where(touch, 0.0, rng.uniform(0.1, 1, n))
    if kind == "neither":
        force[role < 0.3], gap[role > 0.7] = 0.0, 0.0
    if kind == "just touching":
        force, gap = np.zeros(n), np.where(touch, 0.0, gap)
    return (matrix + matrix.T) / 2, gap - matrix @ force, force


def assert_complementary(matrix: np.ndarray, free: np.ndarray, force: np.ndarray) -> None:
    size = np.abs(free).max()
    gap = free + matrix @ force
    # 10 SEAT_RESIDUAL: the stated rounding, and what forming the gap again rounds
    assert force.min() >= 0
    assert gap.min() > -10 * SEAT_RESIDUAL * size
    assert (force * np.abs(gap)).max() <= 10 * SEAT_RESIDUAL * size * force.max()


@pytest.mark.parametrize("seed", range(200))
def test_random_problems_settle_and_nothing_pulls(seed: int) -> None:
    rng = np.random.default_rng([20261122, seed])
    matrix, free, known = problem(rng, KINDS[seed % len(KINDS)])
    force = pushing(matrix, free)
    assert_complementary(matrix, free, force)
    # the energy is least at the known answer; n terms of complementarity SEAT_RESIDUAL are the gap to it
    least, found = (p @ matrix @ p / 2 + free @ p for p in (known, force))
    assert found - least <= len(free) * 10 * SEAT_RESIDUAL * np.abs(free).max() * max(
        force.max(), 1e-300
    )


def test_the_answer_is_that_of_non_negative_least_squares() -> None:
    """½ p·Sp + u0·p = ½ |Lp + L⁻ᵀu0|² − … with S = LᵀL: Lawson and Hanson's method is exact and finite."""
    for seed in range(20):
        matrix, free, _ = problem(np.random.default_rng(seed), "mixed")
        root = cholesky(matrix)
        exact, _ = nnls(root, -np.linalg.solve(root.T, free))
        # the softest direction is 1e4 times as soft as the stiffest, and SEAT_RESIDUAL is of products
        assert pushing(matrix, free) == pytest.approx(exact, abs=1e-4 * exact.max())


def test_no_force_where_nothing_touches() -> None:
    assert not pushing(np.eye(4), np.array([0.0, 1.0, 2.0, 0.0])).any()


def test_places_that_are_one_share_the_force() -> None:
    """Two places with one compliance: the matrix is singular, and what they carry together is known."""
    matrix = np.array([[2.0, 1.0, 1.0], [1.0, 2.0, 2.0], [1.0, 2.0, 2.0]])
    force = pushing(matrix, -np.ones(3))
    # 2a + b = 1 and a + 2b = 1
    assert [force[0], force[1] + force[2]] == pytest.approx([1 / 3, 1 / 3], rel=1e-8)
