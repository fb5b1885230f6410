"""Where the zero jumps, if it jumps once: before anything else is fitted."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.measurement.history import History

FEWEST_STEP_ROWS = 3
"""Fewest rows on either side of a step. Fewer are spikes."""
LEAST_NEW = 1e-6
"""Least part of a step beside the smooth functions, over its square. A step with less is one of these
functions: rounding."""


def sudden_step(history: History, angle_arcsec: np.ndarray, kept: np.ndarray) -> int | None:
    """The row (of all) from which a jump of one unit's zero, beside smooth functions, explains most.

    Parameters
    ----------
    angle_arcsec : (n,) measured less simulated angle. kept : (n,) rows that count.

    Every row is tried. With an orthonormal basis Q of the smooth functions and what they leave, r, a step s
    takes (sᵀr)²/(sᵀs − |Qᵀs|²) off the sum of squares; the products are sums of the rows from the step on.
    """
    rows = np.flatnonzero(kept)
    x = history.torque_Nm[rows] / history.largest_Nm
    zeros = history.unit[rows, None] == np.unique(history.unit[rows])
    direction = direction_of_loading(history)[rows]
    smooth = np.column_stack([zeros, x, np.abs(x), x * np.abs(x), x**3, np.sign(x), direction])
    basis, size, _ = np.linalg.svd(smooth, full_matrices=False)
    basis = basis[:, size > LEAST_NEW * size[0]]
    left = angle_arcsec[rows] - basis @ (basis.T @ angle_arcsec[rows])
    best, place = 0.0, None
    for unit in np.unique(history.unit[rows]):
        own = np.flatnonzero(history.unit[rows] == unit)
        if len(own) < 2 * FEWEST_STEP_ROWS:
            continue
        count = np.arange(len(own), 0, -1.0)
        product = np.cumsum(left[own][::-1])[::-1]
        common = np.cumsum(basis[own][::-1], axis=0)[::-1]
        new = np.maximum(count - (common**2).sum(axis=1), LEAST_NEW * count)
        gain = (product**2 / new)[FEWEST_STEP_ROWS : len(own) - FEWEST_STEP_ROWS + 1]
        if len(gain) and gain.max() > best:
            best, place = float(gain.max()), int(rows[own[FEWEST_STEP_ROWS + int(gain.argmax())]])
    return place
