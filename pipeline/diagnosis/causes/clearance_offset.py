"""A gap that differs from the simulated one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.measurement.history import History

CLEARANCE = "clearance_offset"
"""This cause's id."""


class ClearanceOffset(Cause):
    """The gap is `amplitude` [arcsec] wider than simulated, at 20 °C: twist ±½ of it."""

    id = CLEARANCE
    title = "clearance other than simulated"
    unit = "arcsec"
    exact = True
    shape_doubt = 0.0005
    """One and two deviations cover 73 and 96 % of 26 sizes."""
    vary = "temperature_C"
    reveals = "finely spaced torques around zero, and the temperature held at 20 °C"

    def shapes(self, rig: FitContext) -> list[Shape]:
        return [{}]

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        return history.sign[:, None] / 2

    def spread(self, shape: Shape, rig: FitContext) -> float:
        """About the gap itself, whatever the torque."""
        return rig.prediction.gap_arcsec + rig.prediction.gap_std_arcsec or rig.scale_arcsec

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        return rig.gap_arcsec - rig.prediction.gap_arcsec
