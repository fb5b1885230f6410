"""A quadratic surface through the designs of a tolerance study, and the variance that it explains.

The surface is a polynomial chaos of degree 2: products of polynomials that are orthonormal under each
input's own distribution, so that the squares of its coefficients are shares of the variance (Sudret,
Reliab. Eng. Syst. Saf. 93, 2008, 964-979). Its error is that at sample blocks left out of the fit: the
designs of one block share most of their values, so leaving out one alone would say too little.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from flexspline.pipeline.study.indices import Indices, groups_of, reach, students_factor, within
from flexspline.pipeline.study.tolerance import ScatteredInput

QUADRATURE_NODES = 4096
"""Of the quadrature over each input's distribution."""
LEAST_EIGENVALUE = 1e-6
"""Least eigenvalue of what is left of the normal equations without a block, 1 with all of them."""


@dataclass(frozen=True)
class ResponseSurface:
    """A fitted surface.

    Attributes
    ----------
    polynomials : for each input (3, 3), columns the coefficients of its orthonormal polynomials.
    pairs : inputs whose products are in it; empty where the designs are too few.
    coefficients : (p,) of all designs; `left_out` (G, p) with a group of blocks left out.
    misfit, misfit_high : mean square of its error at designs left out, and the end of its interval,
        in the figure's unit squared.
    errors : at every design, left out of the fit.
    """

    inputs: tuple[ScatteredInput, ...]
    polynomials: tuple[np.ndarray, ...]
    pairs: tuple[tuple[int, int], ...]
    coefficients: np.ndarray
    left_out: np.ndarray
    misfit: float
    misfit_high: float
    errors: np.ndarray

    def at(self, points: np.ndarray) -> np.ndarray:
        """Return the surface's values at points (n, k)."""
        return np.asarray(
            _terms(self.inputs, self.polynomials, self.pairs, points) @ self.coefficients
        )

    @property
    def variance(self) -> float:
        """Variance of the surface, without its misfit."""
        return float((self.coefficients[1:] ** 2).sum())

    @property
    def explained(self) -> float:
        """Q²: the share of the variance at designs left out that the surface explains, at most 1."""
        return 1 - self.misfit / (self.variance + self.misfit)

    def indices(self) -> Indices:
        """Return shares of the variance; the misfit may belong to any input, so every interval holds it."""
        first, total = _members(len(self.inputs), self.pairs)
        return Indices(*self._shares(first), *self._shares(total))

    def _shares(self, members: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        part = members @ self.coefficients**2
        left = self.left_out**2
        half = reach(left @ members.T / left[:, 1:].sum(axis=1, keepdims=True))
        most = self.variance + self.misfit_high
        value = part / (self.variance + self.misfit)
        return value, within(part / most - half, value, (part + self.misfit_high) / most + half)


def surface_through(
    inputs: tuple[ScatteredInput, ...], points: np.ndarray, values: np.ndarray, block: np.ndarray
) -> ResponseSurface | None:
    """Return the surface with products of inputs or without, whichever errs less; None: too few designs.

    Parameters
    ----------
    points : (n, k), values (n,) of designs that could be solved, block (n,) which of 0, 1, … each is of.
    """
    polynomials = tuple(map(_orthonormal, inputs))
    full = tuple(combinations(range(len(inputs)), 2))
    tried = [_fitted(inputs, polynomials, pairs, points, values, block) for pairs in (full, ())]
    return min((s for s in tried if s), key=lambda s: s.misfit, default=None)


def _fitted(
    inputs: tuple[ScatteredInput, ...],
    polynomials: tuple[np.ndarray, ...],
    pairs: tuple[tuple[int, int], ...],
    points: np.ndarray,
    values: np.ndarray,
    block: np.ndarray,
) -> ResponseSurface | None:
    x = _terms(inputs, polynomials, pairs, points)
    if len(x) <= x.shape[1]:
        return None
    q, r = np.linalg.qr(x)
    if np.abs(np.diag(r)).min() < LEAST_EIGENVALUE * np.abs(np.diag(r)).max():
        return None
    right = q.T @ values
    left_out, squares, errors = [], [], np.empty(len(values))
    for group in groups_of(int(block.max()) + 1):
        rows = (block >= group.start) & (block < group.stop)
        if not rows.any():
            continue
        rest = np.eye(x.shape[1]) - q[rows].T @ q[rows]
        if np.linalg.eigvalsh(rest)[0] < LEAST_EIGENVALUE:
            return None
        without = np.linalg.solve(rest, right - q[rows].T @ values[rows])
        errors[rows] = values[rows] - q[rows] @ without
        left_out.append(without)
        squares.append(float(np.mean(errors[rows] ** 2)))
    if len(left_out) < 2:
        return None
    misfit, spread = float(np.mean(squares)), float(np.std(squares, ddof=1))
    high = misfit + students_factor(len(left_out) - 1) * spread / len(left_out) ** 0.5
    solved = np.linalg.solve(r, np.column_stack([right, *left_out])).T
    return ResponseSurface(
        inputs, polynomials, pairs, solved[0], solved[1:], misfit, float(high), errors
    )  # fmt: skip


def _orthonormal(source: ScatteredInput) -> np.ndarray:
    """1, z and z² of the standardised input, made orthonormal over its distribution."""
    z = _standardised(source, source.at((np.arange(QUADRATURE_NODES) + 0.5) / QUADRATURE_NODES))
    _, r = np.linalg.qr(np.vander(z, 3, increasing=True) / QUADRATURE_NODES**0.5)
    return np.asarray(np.linalg.inv(r * np.sign(np.diag(r))[:, None]))


def _standardised(source: ScatteredInput, x: np.ndarray) -> np.ndarray:
    return np.asarray((x - source.nominal) / source.std)


def _terms(
    inputs: Sequence[ScatteredInput],
    polynomials: Sequence[np.ndarray],
    pairs: Sequence[tuple[int, int]],
    points: np.ndarray,
) -> np.ndarray:
    """Columns (n, 1 + 2k + pairs): 1, every input's two polynomials, products of the first ones."""
    evaluated = [
        np.vander(_standardised(i, x), 3, increasing=True) @ p
        for i, p, x in zip(inputs, polynomials, points.T, strict=True)
    ]
    columns = [np.ones(len(points)), *(z[:, d] for z in evaluated for d in (1, 2))]
    return np.column_stack([*columns, *(evaluated[i][:, 1] * evaluated[j][:, 1] for i, j in pairs)])


def _members(k: int, pairs: Sequence[tuple[int, int]]) -> tuple[np.ndarray, np.ndarray]:
    """Which columns count for each input's first-order index, and which for its total one: (k, p)."""
    first = np.hstack(
        [np.zeros((k, 1)), np.repeat(np.eye(k), 2, axis=1), np.zeros((k, len(pairs)))]
    )
    total = first.copy()
    for column, pair in enumerate(pairs, start=1 + 2 * k):
        total[list(pair), column] = 1
    return first, total
