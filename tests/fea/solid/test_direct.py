"""Factors in single precision, the steps that make double of their answers, and when double follows."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_matrix, diags

from flexspline.fea.errors import SolveError
from flexspline.fea.pardiso import pardiso
from flexspline.fea.solid import direct as module
from flexspline.fea.solid.direct import direct, factorised

pytestmark = pytest.mark.skipif(pardiso() is None, reason="MKL has no wheel for this machine")


def beam(n: int, soft: float = 0.0) -> csr_matrix:
    """Differences of the fourth order, as a clamped beam in bending, on a foundation: n unknowns."""
    ends = np.ones(n)
    main = 6 * ends + soft
    return diags(
        [ends, -4 * ends, main, -4 * ends, ends], [-2, -1, 0, 1, 2], shape=(n, n), format="csr"
    )


def spied(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """Whether each factorisation that follows is in single precision."""
    asked: list[bool] = []
    make = module.PardisoFactors

    def spy(matrix: csr_matrix, single: bool) -> object:
        asked.append(single)
        return make(matrix, single)

    monkeypatch.setattr(module, "PardisoFactors", spy)
    return asked


@pytest.mark.parametrize("foundation", [1e-2, 1e-6])
def test_a_large_system_is_factorised_in_single_precision(
    foundation: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Condition numbers of 1.6e3 and 1.6e7: the second is all that single precision resolves."""
    asked = spied(monkeypatch)
    matrix = beam(20_000, foundation)
    true = np.random.default_rng(1).standard_normal(20_000)
    right = matrix @ true
    (found,) = direct(matrix, (right,))
    assert asked == [True]
    off = found - true
    # of the energy; that of displacements is its square root over the condition number's
    assert off @ (matrix @ off) < 1e-15 * (true @ right)


def test_what_single_precision_does_not_resolve_is_left_to_double(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A condition number of 1e12: singular in single precision."""
    asked = spied(monkeypatch)
    matrix = beam(20_000, 1.6e-11)
    right = np.random.default_rng(2).standard_normal(20_000)
    (found,) = direct(matrix, (right,))
    assert asked == [True, False]
    assert np.linalg.norm(matrix @ found - right) < 1e-3 * np.linalg.norm(right)


def test_small_systems_are_factorised_in_double(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = spied(monkeypatch)
    matrix = beam(1000, 1e-3)
    right = np.ones(1000)
    (found,) = direct(matrix, (right,))
    assert np.linalg.norm(matrix @ found - right) < 1e-9 * np.linalg.norm(right)
    assert asked == [False]


def test_steps_that_are_not_enough_are_followed_by_double(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = spied(monkeypatch)
    monkeypatch.setattr(module, "FACTORED_STEPS", 1)
    matrix = beam(20_000, 1e-6)
    right = np.random.default_rng(3).standard_normal(20_000)
    (found,) = direct(matrix, (right,))
    assert asked == [True, False]
    assert np.linalg.norm(matrix @ found - right) < 1e-8 * np.linalg.norm(right)


@pytest.mark.parametrize("single", [True, False])
def test_a_matrix_that_is_not_positive_definite_is_refused(single: bool) -> None:
    matrix = beam(1000, -1.0)
    with pytest.raises(SolveError, match="unsupported"), factorised(matrix, single):
        pass


def test_columns_in_any_order_are_taken() -> None:
    matrix = beam(500, 1e-2)
    back_to_front = np.concatenate(
        [np.arange(b, a, -1) - 1 for a, b in zip(matrix.indptr, matrix.indptr[1:], strict=False)]
    )
    mixed = csr_matrix(
        (matrix.data[back_to_front], matrix.indices[back_to_front], matrix.indptr), matrix.shape
    )
    assert not mixed.has_sorted_indices
    true = np.arange(500.0)
    with factorised(mixed) as back:
        # a condition number of 1.6e3
        assert back(matrix @ true) == pytest.approx(true, abs=1e-8)
