"""The torques near zero at which it is not known which flanks are in contact."""

from __future__ import annotations

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm

BAND_SIGMAS, BAND_SHARE = 4.0, 0.035
"""Half width of the crossing: standard deviations of the torque noise (one row in 16 000 lies further
off), and at least this share of the largest torque; docs/diagnosis.md, "Which rows"."""


def crossing_band_Nm(history: History) -> float:
    """|T| below which the side of the gap is not known."""
    largest = history.largest_Nm
    return max(BAND_SIGMAS * torque_noise_Nm(history), BAND_SHARE * largest)
