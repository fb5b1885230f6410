"""Sizes of deviations: root mean square, and a scale of noise that outliers do not move."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

SIGMA_PER_MAD, MAD_PER_SIGMA = 1.4826, 0.6745
"""Standard deviation over median absolute deviation of a normal distribution, 1/Φ⁻¹(3/4), and the reverse."""


def rms(values: ArrayLike) -> float:
    """Root mean square, in the unit of the values.

    Examples
    --------
    >>> round(rms([3.0, -4.0]), 3)
    3.536
    """
    return float(np.sqrt(np.mean(np.square(values))))
