"""Moving means over the rows around each row."""

from __future__ import annotations

import numpy as np


def moving_mean(values: np.ndarray, reach: np.ndarray | int) -> tuple[np.ndarray, np.ndarray]:
    """(n,) over as many rows ahead as behind, `reach` or as many as there are; of how many rows."""
    row, sums = np.arange(len(values)), np.concatenate([[0.0], np.cumsum(values)])
    reach = np.minimum(reach, np.minimum(row, len(values) - 1 - row))
    count = 2 * reach + 1
    return (sums[row + reach + 1] - sums[row - reach]) / count, count
