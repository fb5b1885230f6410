"""Least squares with amounts that are not negative, for columns as alike as two loop shapes."""

from __future__ import annotations

import numpy as np
from scipy.optimize import nnls

RIDGE = 1e-5
"""Of a unit column: it keeps the solver from circling among near twins and costs 1e-10 of the fit."""


def amounts(columns: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Amounts ≥ 0 of the columns (n, m) that come nearest to the target (n,)."""
    size = np.linalg.norm(columns, axis=0)
    used = size > 1e-9
    m = int(used.sum())
    out = np.zeros(len(size))
    if m:
        unit = np.concatenate([columns[:, used] / size[used], RIDGE * np.eye(m)])
        length = np.linalg.norm(target) or 1.0
        padded = np.concatenate([target / length, np.zeros(m)])
        out[used] = nnls(unit, padded, maxiter=100 * m)[0] * length / size[used]
    return out


def left_over(columns: np.ndarray, target: np.ndarray) -> float:
    """Length of the target that they leave."""
    return float(np.linalg.norm(target - columns @ amounts(columns, target)))
