"""Flexible functions of a channel: smooth, periodic, or with a free value at each level."""

from __future__ import annotations

import numpy as np

from flexspline.geometry.above_zero import ABOVE_ZERO

SPLINE = 6
"""Degree of a smooth function over a channel, Legendre polynomials: up to five turns. More turns are
waves and ripples, which begin with 3 half periods."""
FEW_LEVELS, MANY_LEVELS = 8, 40
"""Columns of one nuisance term at most. Each costs evidence: few find a weak scatter; a strong one needs one
for each cycle or position, as what neighbours that share a level leave passes for slow noise."""


def to_one(columns: np.ndarray, least: float = ABOVE_ZERO) -> np.ndarray:
    """(n,) or (n, k) each over its largest size; a column of 0, or of less than `least`, stays small."""
    return columns / np.maximum(np.abs(columns).max(axis=0), least)


def less_fitted(values: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """Values (n,) or (n, k) less what the columns (n, b) of a basis can be of them, by least squares."""
    return np.asarray(values - basis @ np.linalg.lstsq(basis, values, rcond=None)[0])


def smooth(x: np.ndarray, degree: int = SPLINE) -> np.ndarray:
    """(n, degree) Legendre polynomials of degree 1 to `degree` over −1…1."""
    return np.polynomial.legendre.legvander(np.clip(x, -1, 1), degree)[:, 1:]


def wave(x: np.ndarray, half_periods: int) -> np.ndarray:
    """(n, 2) cosine and sine with so many half periods over 0…1."""
    turn = np.pi * half_periods * x
    return np.column_stack([np.cos(turn), np.sin(turn)])


def levels(values: np.ndarray, most: int = FEW_LEVELS) -> np.ndarray:
    """(n, k) one column per level but the first; neighbouring levels share one where they are over `most`."""
    seen = np.unique(values)
    if len(seen) > most + 1:
        seen = np.quantile(values, np.linspace(0, 1, most + 2)[:-1])
        index = np.clip(np.searchsorted(seen, values, side="right") - 1, 0, None)
    else:
        index = np.searchsorted(seen, values)
    return np.column_stack([index == i for i in range(1, max(2, index.max() + 1))]).astype(float)
