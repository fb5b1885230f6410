"""The temperature without the noise of its reading, which does not act on the gear.

With the noise a gap that follows the temperature explains the angles best with a lag that is not there: a lag
takes the mean of many readings. One of 7 arcsec/K, read with 0.05 K of noise, came out as 6.6 with a lag.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.moving_mean import moving_mean
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.measurement.white_noise import white_noise

INTERVAL_SIGMAS = 2.0
"""Half an interval about a mean, in standard deviations. Noise alone leaves it in one row of 20, which is
then averaged over fewer rows."""
LARGEST_ROUNDING_K = 0.5
"""Thermometers show 0.1, 0.2 or 0.5 K; larger steps from cycle to cycle are an oven's."""
STEP_SHARE = 0.01
"""Of a step of rounding, within which two are one: what is written in decimals differs by its last bit."""
REACHES = (1, 2, 4, 8, 16, 32, 64)
"""Rows on either side of the means that are tried. The last one has a tenth of the noise."""


@once
def temperature_without_noise(history: History) -> np.ndarray:
    """(n,) °C: of each row the mean of as many rows about it as tell nothing but noise.

    By intersecting confidence intervals (Goldenshluger and Nemirovski, Math. Methods of Statistics 6, 1997):
    the mean over more rows is taken as long as its interval meets those of all fewer rows.

    Raises
    ------
    ValueError : it was not recorded.
    """
    if history.temperature_C is None:
        raise ValueError("a gap that follows temperature needs a temperature")
    temperature = np.array(history.temperature_C, float)
    for rows in history.unit_slices:
        temperature[rows] = _smoothed(temperature[rows], history.time_or_rows(rows))
    return temperature


def _rounding(readings: np.ndarray) -> float:
    """Deviation of what rounding does, where readings mostly stay, and else mostly change by one step."""
    moved = np.abs(np.diff(readings))
    moved = moved[moved > 0]
    if len(moved) == 0 or len(moved) > len(readings) / 2:
        return 0.0
    step = float(np.median(moved))
    alike = np.abs(moved - step) < STEP_SHARE * step
    rounded = step <= LARGEST_ROUNDING_K and alike.mean() > 1 / 2
    return step / np.sqrt(12) if rounded else 0.0


def _smoothed(readings: np.ndarray, t: np.ndarray) -> np.ndarray:
    """The means, and what they find in the rest: of a curve they alone take a part (twicing: Tukey, 1977)."""
    noise = max(white_noise(readings, t) or 0.0, _rounding(readings))
    if noise == 0:
        return readings
    reach = np.zeros(len(readings), int)
    growing = np.ones(len(readings), bool)
    low, high = readings - INTERVAL_SIGMAS * noise, readings + INTERVAL_SIGMAS * noise
    for most in REACHES:
        mean, count = moving_mean(readings, most)
        half = INTERVAL_SIGMAS * noise / np.sqrt(count)
        low, high = np.maximum(low, mean - half), np.minimum(high, mean + half)
        growing &= low <= high
        reach[growing] = most
    first, _ = moving_mean(readings, reach)
    return first + moving_mean(readings - first, reach)[0]
