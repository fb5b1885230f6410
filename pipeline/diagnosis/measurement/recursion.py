"""First-order recursions over a record's rows, solved as a banded system of equations."""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dtbtrs


def first_order(keep: np.ndarray | float, drive: np.ndarray) -> np.ndarray:
    """x of the recursion x_i = k_i·x_{i−1} + d_i, from x_{−1} = 0: a lower bidiagonal system.

    Parameters: keep, k_1 … k_{n−1} (n − 1,) or one for all; drive, d (n, …), left as it is.
    """
    band = np.ones((2, len(drive)), order="F")
    band[1, :-1] = np.negative(keep)
    right = np.array(drive, dtype=float, order="F").reshape(len(drive), -1, order="F")
    solution, _ = dtbtrs(band, right, uplo="L", diag="U", overwrite_b=1)
    return np.asarray(solution).reshape(drive.shape, order="F")
