"""The white noise of a channel whose true value changes slowly."""

from __future__ import annotations

from itertools import permutations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.pipeline.diagnosis.robust import robust_std

FEWEST_FOR_NOISE = 8
"""Fewest readings. With fewer, the median of third differences is of less than five."""
FIFTH_PER_SIGMA = 0.2533
"""What a fifth of |x| lies below for x normal with deviation 1, Φ⁻¹(3/5)."""


def white_noise(readings: np.ndarray, t: np.ndarray) -> float | None:
    """Standard deviation of readings (n,) at times (n,), in their unit; None of too few.

    The least of four estimates, each too large where its assumption fails: from readings off the straight
    line between their neighbours (ramps), from third differences (curves, evenly sampled; and at their times,
    where the clock is good), and from the smallest fifth of the steps from one to the next (holds).
    """
    if len(readings) < FEWEST_FOR_NOISE:
        return None
    span = np.maximum(t[2:] - t[:-2], ABOVE_ZERO)
    share = np.clip((t[1:-1] - t[:-2]) / span, 0.0, 1.0)
    off = readings[1:-1] - (1 - share) * readings[:-2] - share * readings[2:]
    line = robust_std(off / np.sqrt(1 + share**2 + (1 - share) ** 2))
    # 20 = 1² + 3² + 3² + 1²
    even = robust_std(np.diff(readings, 3)) / np.sqrt(20)
    timed = robust_std(_off_parabola(readings, t))
    first = np.quantile(np.abs(np.diff(readings)), 0.2) / FIFTH_PER_SIGMA / np.sqrt(2)
    return float(min(line, even, timed, first))


def _off_parabola(readings: np.ndarray, t: np.ndarray) -> np.ndarray:
    """(m,) third divided differences, scaled to the noise of one reading; those of four different times.

    Where half of them or more have not four, by a coarse clock, ∞ once: a median of few is any number.
    """
    four, at = (sliding_window_view(values, 4) for values in (readings, t))
    apart = np.diff(at, axis=1).min(axis=1) > ABOVE_ZERO
    if apart.mean() <= 1 / 2:
        return np.array([np.inf])
    four, begun, span = four[apart], at[apart, :1], at[apart, -1:] - at[apart, :1]
    at = (at[apart] - begun) / span
    weight = np.ones_like(at)
    for one, other in permutations(range(4), 2):
        weight[:, one] /= at[:, one] - at[:, other]
    return np.asarray((weight * four).sum(axis=1) / np.linalg.norm(weight, axis=1))
