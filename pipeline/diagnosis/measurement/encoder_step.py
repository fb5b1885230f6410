"""The resolution of the encoder that reads the angle, and its rounding error."""

from __future__ import annotations

import numpy as np

ONE_READING_ARCSEC = 1e-4
"""Readings that differ by less are equal: a conversion of units rounds them, and steps of encoders are
larger."""
ROUNDING_RATIO = 12.0
"""A step's square over the variance of rounding to it."""
OFF_A_STEP = 0.1
"""Share of a step by which a difference may miss a whole number of steps. By chance a fifth of all
differences are as near."""
WHOLE_STEPS = 0.8
"""Share of neighbouring readings that many whole steps apart, above which steps are an encoder's: one may
change its readings by hand or by an outlier."""


def undithered(variance: float, step: float) -> float:
    """Variance of a rounding that follows what is read, among readings of this variance; in step's unit².

    All of step²/12 without noise. With normal noise of deviation σ the saw-tooth's harmonics, the first
    foremost, are smaller by exp(−2π²σ²/step²), and the rest of the rounding is noise as well.
    Source: Widrow, Kollár, Quantization Noise (2008), chapter 4.
    """
    if step <= 0:
        return 0.0
    rounding = step**2 / ROUNDING_RATIO
    noise = max(variance - rounding, 0.0)
    return rounding * float(np.exp(-4 * np.pi**2 * noise / step**2))


def encoder_step(angle_arcsec: np.ndarray) -> float:
    """Least difference between two readings [arcsec]: an encoder's readings jump with the motion too.

    0 where most readings are no whole steps apart: a record without noise that repeats itself has few
    readings, and no encoder made their differences.
    """
    apart = np.diff(np.unique(np.round(angle_arcsec / ONE_READING_ARCSEC))) * ONE_READING_ARCSEC
    if not len(apart):
        return 0.0
    step = float(apart.min())
    steps = apart / step
    # a difference is known to a reading's rounding, the step in it as often as the step goes into it
    unsure = OFF_A_STEP + ONE_READING_ARCSEC / step * (1 + steps)
    return step if np.mean(np.abs(steps - np.round(steps)) < unsure) > WHOLE_STEPS else 0.0


def common_step(angle_arcsec: np.ndarray) -> float:
    """Greatest step [arcsec] of which all differences of readings are whole multiples.

    Of few readings none need be next to another one, and no two a step apart.
    """
    readings = np.unique(np.round(angle_arcsec / ONE_READING_ARCSEC).astype(np.int64))
    return float(np.gcd.reduce(np.diff(readings), initial=0)) * ONE_READING_ARCSEC
