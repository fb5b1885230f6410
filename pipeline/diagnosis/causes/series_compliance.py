"""An elastic part that the simulation leaves out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.measurement.history import History

SERIES = "series_compliance"
"""This cause's id."""
STIFFER = "gear stiffer than simulated"


class SeriesCompliance(Cause):
    """A spring in series that the simulation does not have: twist c·T with c [arcsec per N·m]."""

    id = SERIES
    title = "elastic part left out of the simulation"
    unit = "%"
    per_torque = True
    spread_share = 0.4
    """A joint or bearing that was left out may be nearly as compliant as the simulated parts."""
    ratio = "in % of the simulated compliance"
    exact = True
    elastic = True
    shape_doubt = 0.0007
    """One and two deviations cover 59 and 90 % of 29 sizes."""
    vary = "torque_amplitude"
    reveals = (
        "larger torque within the rated one, and the part suspected (bolts, tooth mesh) clamped or "
        "removed"
    )

    def title_at(self, magnitude: float) -> str:
        return self.title if magnitude >= 0 else STIFFER

    def shapes(self, rig: FitContext) -> list[Shape]:
        return [{}]

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        return history.torque_Nm[:, None]

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        return 100 * (rig.compliance / rig.prediction.compliance - 1)
