"""Conjugate gradients that report an early stop, and the spectrum that they estimate."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, log

import numpy as np

from flexspline.fea.errors import SolveError

Operator = Callable[[np.ndarray], np.ndarray]
RATE_STEPS, RATE_AGAIN = 10, 10
"""Steps after which the rate of convergence is checked, again and again; a usual iteration takes 15 to 60.
After ten steps, 98 to 138 more were expected of shafts that took 246 to 334 steps (elements 30 to 80 times as
long as thick), and 4 to 71 of others."""


@dataclass(frozen=True)
class Iterated:
    """x (N,), steps taken, the range of M K's eigenvalues as seen, and whether more steps are needed."""

    x: np.ndarray
    steps: int
    spectrum: tuple[float, float]
    early: bool


def dot(a: np.ndarray, b: np.ndarray) -> float:
    """Return a·b, by one thread. BLAS would start its own threads, whose waiting slows oneMKL's products."""
    return float(np.einsum("i,i", a, b))


def conjugate_gradients(
    apply: Operator,
    precondition: Operator,
    right: np.ndarray,
    most: int,
    allowed: Callable[[np.ndarray], float] = lambda x: 0.0,
    worth: float = inf,
) -> Iterated:
    """Take at most `most` steps for K x = f from x = 0, until the error's energy is below `allowed`.

    It ends early if the rate of its later half predicts more than `worth` further steps.

    The energy, (x − x*)·K(x − x*), is at most r·M r over the smallest eigenvalue of M K, which the steps see
    from above: the caller checks the answer, and how many steps it took.

    The steps' lengths are the coefficients of Lanczos' tridiagonal matrix of M K, whose eigenvalues lie
    within M K's and reach its ends first (Saad, Iterative Methods for Sparse Linear Systems, 2003, 6.7.3).

    Raises
    ------
    SolveError : K or M is not positive definite.
    """
    x, r = np.zeros_like(right), right.copy()
    z = precondition(r)
    p, rz = z.copy(), dot(r, z)
    lengths: list[float] = []
    turns: list[float] = []
    seen = [rz]
    met = False
    while not met and len(lengths) < most:
        q = apply(p)
        stiffness = dot(p, q)
        if not (stiffness > 0 and rz > 0):
            raise SolveError(
                f"step {len(lengths)} of the iteration found a matrix that is not positive definite"
                f" (p·Kp = {stiffness:.1e}, r·Mr = {rz:.1e}): part of the model may be unsupported"
            )
        lengths.append(rz / stiffness)
        x += lengths[-1] * p
        r -= lengths[-1] * q
        z = precondition(r)
        before, rz = rz, dot(r, z)
        turns.append(rz / before)
        p *= turns[-1]
        p += z
        seen.append(rz)
        limit = allowed(x)
        met = _within(limit, rz, lengths, turns)
        if not met and _steps_left(limit, seen, lengths, turns) > worth:
            break
    return Iterated(x, len(lengths), _spectrum(lengths, turns), not met)


def _within(allowed: float, rz: float, lengths: list[float], turns: list[float]) -> bool:
    """Whether the error's energy is; eigenvalues, which M keeps below 1, are looked at when it may be."""
    return rz <= allowed and rz <= allowed * _spectrum(lengths, turns)[0]


def _steps_left(
    allowed: float, seen: list[float], lengths: list[float], turns: list[float]
) -> float:
    """By the rate at which r·M r, as `seen`, fell in the later half of the steps; 0 while too early."""
    steps = len(lengths)
    if steps < RATE_STEPS or steps % RATE_AGAIN or not allowed > 0:
        return 0.0
    rate = log(seen[steps // 2] / seen[-1]) / (steps - steps // 2)
    left = log(seen[-1] / (allowed * min(1.0, _spectrum(lengths, turns)[0])))
    return left / rate if rate > 0 else inf


def _spectrum(lengths: list[float], turns: list[float]) -> tuple[float, float]:
    from scipy.linalg import eigh_tridiagonal

    a, b = np.array(lengths), np.array(turns)
    diagonal = 1 / a
    diagonal[1:] += b[:-1] / a[:-1]
    eigenvalues = eigh_tridiagonal(diagonal, np.sqrt(np.abs(b[:-1])) / a[:-1], eigvals_only=True)
    return float(eigenvalues[0]), float(eigenvalues[-1])
