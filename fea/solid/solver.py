"""Sparse solution with prescribed unknowns, by factors or by iteration, and the checks of the result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from scipy.sparse import csr_matrix
from skfem import condense

from flexspline.fea.axisymmetric.harmonics import LOST_ENERGY_LIMIT
from flexspline.fea.errors import IterationError, SolveError
from flexspline.fea.solid.direct import direct
from flexspline.fea.solid.iteration import dot
from flexspline.fea.solid.memory import SolverKind, choose_solver, steps_of_factors
from flexspline.fea.solid.twolevel import TwoLevel, two_level
from flexspline.geometry.above_zero import ABOVE_ZERO

ITERATION_ENERGY = 1e-7
"""Energy of the error over u·Ku at which an iteration ends. K is off by this share, displacements by its
root, 3e-4. The mesh's own errors are a thousand times larger. On two random shafts 1e-9 took a third more
steps: 32 for 24, and 124 for 92 where elements are thin."""
ITERATION_ENERGY_LIMIT = 1e-5
"""Largest accepted true residual. u·(Ku − f) is no check here, since conjugate gradients keep the residual
orthogonal to u wherever they stop."""


@dataclass(frozen=True)
class Solution:
    """Unknowns (N,), reactions Ku − f (N,) on the prescribed ones, the relative residual, and how."""

    unknowns: np.ndarray
    reactions: np.ndarray
    residual: float
    free_count: int
    solver: SolverKind


@dataclass(frozen=True)
class Case:
    """Nodal forces (N,) [N] on a supported body, and values (k,) [mm] of what is prescribed."""

    load: np.ndarray
    values: np.ndarray


def solve(
    matrix: csr_matrix,
    case: Case,
    fixed: np.ndarray,
    corners: Callable[[], csr_matrix] | None = None,
    by: SolverKind | None = None,
    slow: bool = False,
) -> Solution:
    """Solve K u = f with u[fixed] = values; parameters and errors as `solve_each`."""
    (solution,) = solve_each(matrix, (case,), fixed, corners, by, slow)
    return solution


def solve_each(
    matrix: csr_matrix,
    cases: Sequence[Case],
    fixed: np.ndarray,
    corners: Callable[[], csr_matrix] | None = None,
    by: SolverKind | None = None,
    slow: bool = False,
) -> list[Solution]:
    """Solve K u = f with u[fixed] = values, of all cases by the same factors.

    Parameters
    ----------
    matrix : (N, N) symmetric positive definite once the fixed unknowns are removed.
    fixed : (k,) indices, unique.
    corners : makes `twolevel.corner_interpolation` of the mesh; without it only factors are possible.
    by : the way to solve; chosen by unknowns and memory when absent.
    slow : whether an iteration is expected to take long, so that factors are preferred.

    Raises
    ------
    SolveError : the solver failed or loses energy, so the part is not supported; its kinds are
        MemoryShortError, before anything is begun, and IterationError.
    """
    is_free = np.ones(matrix.shape[0], bool)
    is_free[fixed] = False
    free = np.flatnonzero(is_free)
    systems = [_System.of(matrix, case, fixed, is_free) for case in cases]
    entries = round(matrix.nnz * len(free) / len(is_free))
    how = by or choose_solver(len(free), entries, corners is not None, slow)
    if how == "iterative" and corners is not None:
        worth = inf if by else steps_of_factors(len(free), entries)
        try:
            with two_level(matrix, is_free, corners()) as prepared:
                iterated = [_iterated(prepared, system, worth) for system in systems]
        except IterationError:
            if worth == inf:
                raise
            how = "direct"  # below, where the error holds none of the iteration's memory any more
        else:
            return [
                _checked(matrix, system, u, free, how, error_energy)
                for system, (u, error_energy) in zip(systems, iterated, strict=True)
            ]
    right = [system.right[free] for system in systems]
    free_values = direct(condense(matrix, D=fixed, expand=False), right)
    solutions = []
    for system, values in zip(systems, free_values, strict=True):
        u = system.lift.copy()
        u[free] = values
        solutions.append(_checked(matrix, system, u, free, how))
    return solutions


@dataclass(frozen=True)
class _System:
    """A case's `load`; `lift`, its prescribed values, and K times it; `right`, on the free unknowns."""

    load: np.ndarray
    lift: np.ndarray
    of_lift: np.ndarray
    right: np.ndarray

    @classmethod
    def of(cls, matrix: csr_matrix, case: Case, fixed: np.ndarray, is_free: np.ndarray) -> _System:
        lift = np.zeros(matrix.shape[0])
        lift[fixed] = case.values
        of_lift = matrix @ lift
        return cls(case.load, lift, of_lift, np.where(is_free, case.load - of_lift, 0.0))


def _iterated(prepared: TwoLevel, system: _System, worth: float) -> tuple[np.ndarray, float]:
    """Unknowns (N,), and the energy of their error."""
    allowed = _allowed_energy(system.load, system.right, system.lift, system.of_lift)
    x, error_energy = prepared.solve(system.right, allowed, worth)
    return system.lift + x, error_energy


def _checked(
    matrix: csr_matrix,
    system: _System,
    u: np.ndarray,
    free: np.ndarray,
    how: SolverKind,
    error_energy: float = 0.0,
) -> Solution:
    forces = matrix @ u
    off = (forces - system.load)[free]
    residual = float(np.linalg.norm(off)) / max(float(np.linalg.norm(system.right)), ABOVE_ZERO)
    energy = max(float(u @ forces), ABOVE_ZERO)
    _refuse_lost(abs(float(u[free] @ off)) / energy, error_energy / energy, residual)
    return Solution(u, forces - system.load, residual, len(free), how)


def _allowed_energy(
    load: np.ndarray, right: np.ndarray, lift: np.ndarray, of_lift: np.ndarray
) -> Callable[[np.ndarray], float]:
    """What an iteration's error may be [N·mm], of the free unknowns x: ITERATION_ENERGY of u·Ku.

    u is x and `lift`, the prescribed values; K times `lift` is `of_lift`, K x `right` on the free unknowns.
    """
    lift_energy, of_x = float(lift @ of_lift), 2 * load - right
    return lambda x: ITERATION_ENERGY * abs(lift_energy + dot(x, of_x))


def _refuse_lost(unbalanced: float, unfinished: float, residual: float) -> None:
    """Raise SolveError where shares of the energy are lost: out of balance, or in an iteration's error."""
    for lost, limit in ((unbalanced, LOST_ENERGY_LIMIT), (unfinished, ITERATION_ENERGY_LIMIT)):
        if not lost < limit:
            raise SolveError(
                f"{lost:.1e} of the energy is lost in the solve, allowed {limit:.0e}"
                f" (relative residual {residual:.1e}): part of the model may be unsupported"
            )
