"""Sparse factorisation of symmetric positive definite matrices: by Pardiso, or SuperLU without MKL.

A large system's factors are in single precision, half the memory and half the time, and precondition
conjugate gradients in double.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress

import numpy as np
from scipy.sparse import csr_matrix

from flexspline.fea.errors import SolveError
from flexspline.fea.pardiso import PardisoFactors, pardiso
from flexspline.fea.solid.iteration import conjugate_gradients, dot
from flexspline.fea.superlu import SOLID_PANEL, superlu

Back = Callable[[np.ndarray], np.ndarray]
SINGLE_FROM = 10_000
"""Unknowns from which `direct` factorises in single precision: smaller ones take 0.1 s in double."""
FACTORED_ENERGY = 1e-15
"""Energy of the error over f·u at which the steps with factors in single precision end. Factors in double
leave 1e-29 in torsion and 1e-16 in a thin free rim."""
FACTORED_ROUNDS = 2
"""Times that the steps start from the true residual. Rounding in the first run makes K of a free rim wrong by
1e-8. The second run, mostly one step, leaves 2e-10."""
FACTORED_STEPS = 30
"""Most steps of a run. Measured: 2 to 3 in torsion, 3 to 4 on the ellipse, 4 to 15 in free rims (walls of
1/80 to 1/370 of the diameter, 24 000 to 216 000 unknowns)."""


@contextmanager
def factorised(matrix: csr_matrix, single: bool = False) -> Iterator[Back]:
    """Give K⁻¹ as a function of the right-hand side (N,), for as long as the context lasts.

    `single`: in single precision, where MKL is and that finds K positive definite.

    Raises
    ------
    SolveError : K is not positive definite, or the factors do not fit the memory.
    """
    if pardiso() is None:
        yield _superlu(matrix)
        return
    try:
        factors = PardisoFactors(matrix, single)
    except SolveError:
        if not single:
            raise
        factors = PardisoFactors(matrix, single=False)
    try:
        yield factors.solve
    finally:
        factors.release()


def direct(matrix: csr_matrix, rights: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Solve K u = f for each right-hand side (N,) by the same factors.

    Large systems by conjugate gradients on factors in single precision; by factors in double where those
    fail, or are not near enough to K⁻¹.

    Raises
    ------
    SolveError : as `factorised`.
    """
    any_load = any(right.any() for right in rights)
    if pardiso() is not None and matrix.shape[0] >= SINGLE_FROM and any_load:
        with factorised(matrix, single=True) as back, suppress(SolveError):
            return [_in_double(matrix, right, back) for right in rights]
    with factorised(matrix) as back:
        return [back(right) for right in rights]


def _in_double(matrix: csr_matrix, right: np.ndarray, back: Back) -> np.ndarray:
    """K⁻¹ f by conjugate gradients that `back`, factors in single precision, precondition.

    Raises
    ------
    SolveError : those are not near enough to K⁻¹, or FACTORED_STEPS are not enough.
    """
    x = np.zeros_like(right)
    for _ in range(FACTORED_ROUNDS):
        before = x

        def allowed(more: np.ndarray, before: np.ndarray = before) -> float:
            return FACTORED_ENERGY * abs(dot(before + more, right))

        residual = right - matrix @ before
        correction = conjugate_gradients(matrix.__matmul__, back, residual, FACTORED_STEPS, allowed)
        if correction.early:
            raise SolveError(f"{FACTORED_STEPS} steps were not enough")
        x = before + correction.x
    return x


def _superlu(matrix: csr_matrix) -> Back:
    try:
        return superlu(matrix, SOLID_PANEL).solve
    except RuntimeError as fault:  # exactly singular
        raise SolveError(f"{fault}: part of the model may be unsupported") from fault
