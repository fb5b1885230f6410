"""Torque through two lags: what a lag of the gear is made of, and no smooth function of torque can be."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import lags
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_s

LAGGING = (0.1, 0.4)
"""Time constants, as shares of a ramp, of what a lag can be: a short one, and the longest of
`rate_dependence`."""


def lagging_torque(history: History) -> np.ndarray:
    """(n, 2) torque [N·m] through a short and a long lag; no columns without time or movement."""
    ramp = ramp_s(history)
    if ramp <= 0:
        return np.empty((len(history), 0))
    return lags(history.torque_Nm, history, np.array(LAGGING) * ramp)
