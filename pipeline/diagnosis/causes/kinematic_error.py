"""Position error periodic in the wave generator's angle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.causes.periodic import (
    PeriodicShapes,
    harmonic,
    largest_amplitude,
)
from flexspline.pipeline.diagnosis.measurement.history import History

KINEMATIC = "kinematic_error"
"""This cause's id."""


class PeriodicPositionDeviation(PeriodicShapes, Cause):
    """Angle Σ a·cos nφ + b·sin nφ [arcsec], whatever the torque."""

    id = KINEMATIC
    title = "kinematic error (position error periodic in the wave generator's angle)"
    unit = "arcsec"
    spread_share = 0.15
    """Position errors are a part of the twist at rated torque."""
    others = True
    reveals = "the same sweep at many wave generator angles, visited in mixed order"

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        return harmonic(shape, history)

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        return largest_amplitude(elements)
