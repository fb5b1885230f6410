"""A torque reading that is shifted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.measurement.history import History

OFFSET = "torque_offset"
"""This cause's id."""


class TorqueOffset(Cause):
    """The reading is `amplitude` [N·m] above the true torque: every other term sees the true one.

    On a straight branch that is a shift of the angle's zero, which is free; it shows where the torque
    changes sign. Its amplitude is searched by `pipeline.diagnosis.sweep.crossing.gap_crossing`, not linearly.
    """

    id = OFFSET
    title = "shifted torque reading"
    unit = "N·m"
    spread_share = 0.1
    """Share of the largest torque: a torque cell that was not set to zero. Judgement."""
    shape_doubt = 0.0
    """It has one shape; the doubt of its place is `sweep/crossing/crossing_likelihood.py`'s: of 156 sizes one
    and two deviations cover 67 and 98 %."""
    reveals = "the reading of the unloaded torque cell, and fine steps through zero torque"

    def shapes(self, rig: FitContext) -> list[Shape]:
        return []

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        return np.zeros((len(history), 1))

    def spread(self, shape: Shape, rig: FitContext) -> float:
        return self.spread_share * rig.largest_Nm

    def corrected(self, elements: Sequence[Element], history: History) -> History:
        return history.shifted(sum(e.amplitudes[0] for e in elements))
