"""A gap that changes with temperature."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, Rig, Shape
from flexspline.pipeline.diagnosis.causes.operators import lags
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.prediction import REFERENCE_C

LAGS = (0.02, 0.05, 0.12, 0.3)
"""As shares of the record's duration; besides none."""


class ThermalClearance(Cause):
    """Gap k·(ϑ − 20 °C) with k [arcsec/K]; the gear may lag the sensor by a time constant."""

    id = "thermal_clearance"
    title = "clearance that changes with temperature"
    unit = "arcsec/K"
    tunable = ("lag_s",)
    vary = "temperature_C"
    shows_over = "temperature_C"
    shows_as = "gap"
    reveals = "the same sweep at another temperature, the gear soaked, in the same cycle"

    def shapes(self, rig: Rig) -> list[Shape]:
        if rig.history.temperature_C is None:
            return []
        longest = LAGS[-1] * rig.duration_s
        lags_s = [0.0, *(s * rig.duration_s for s in LAGS if rig.duration_s > 0)]
        return [{"lag_s": lag, "longest_lag_s": longest} for lag in lags_s]

    def possible(self, shape: Shape) -> bool:
        """A lag as long as the record makes any temperature a constant, which is another cause."""
        return shape["lag_s"] <= shape["longest_lag_s"]

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        if history.temperature_C is None:
            raise ValueError("thermal clearance needs a temperature")
        temperature = history.temperature_C
        if shape["lag_s"] > 0:
            temperature = lags(temperature, history, np.array([shape["lag_s"]]))[:, 0]
        return ((temperature - REFERENCE_C) * history.sign / 2)[:, None]

    def spread(self, shape: Shape, rig: Rig) -> float:
        return 0.08 * rig.scale_arcsec

    def magnitude(self, elements: Sequence[Element], rig: Rig) -> float:
        return sum(e.amplitudes[0] for e in elements)
