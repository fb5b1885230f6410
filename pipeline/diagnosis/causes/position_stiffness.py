"""Compliance that varies with the wave generator's angle."""

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

POSITION = "position_stiffness"
"""This cause's id."""


class PositionStiffness(PeriodicShapes, Cause):
    """Twist T·Σ (a·cos nφ + b·sin nφ) with a, b [arcsec per N·m]."""

    id = POSITION
    title = "stiffness that varies with the wave generator's angle"
    unit = "%"
    per_torque = True
    spread_share = 0.15
    """As the wave generator turns, the number of teeth in mesh changes by one in seven or less."""
    ratio = "amplitude of the compliance in % of its mean"
    shape_doubt = 0.003
    """One and two deviations cover 71 and 100 % of 7 sizes."""
    shows_as = "compliance"
    reveals = "the same sweep at many wave generator angles"

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        return harmonic(shape, history) * history.torque_Nm[:, None]

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        return 100 * largest_amplitude(elements) / rig.compliance
