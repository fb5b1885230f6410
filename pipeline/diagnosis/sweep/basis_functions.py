"""Flexible functions of a channel: smooth, periodic, or free level by level."""

from __future__ import annotations

import numpy as np

SPLINE = 6
"""Degree of a smooth function over a channel, Legendre polynomials: up to five turns. More turns are
waves and ripples, which begin with 3 half periods."""
MOST_LEVELS = 8
"""Columns of one nuisance term at most: as each costs evidence, more would never pay."""


def smooth(x: np.ndarray, degree: int = SPLINE) -> np.ndarray:
    """(n, degree) Legendre polynomials of degree 1 to `degree` over −1…1."""
    return np.polynomial.legendre.legvander(np.clip(x, -1, 1), degree)[:, 1:]


def wave(x: np.ndarray, half_periods: int) -> np.ndarray:
    """(n, 2) cosine and sine with so many half periods over 0…1."""
    turn = np.pi * half_periods * x
    return np.column_stack([np.cos(turn), np.sin(turn)])


def levels(values: np.ndarray) -> np.ndarray:
    """(n, k) one column per level but the first; neighbouring levels share one where they are many."""
    seen = np.unique(values)
    if len(seen) > MOST_LEVELS + 1:
        seen = np.quantile(values, np.linspace(0, 1, MOST_LEVELS + 2)[:-1])
        index = np.clip(np.searchsorted(seen, values, side="right") - 1, 0, None)
    else:
        index = np.searchsorted(seen, values)
    return np.column_stack([index == i for i in range(1, max(2, index.max() + 1))]).astype(float)
