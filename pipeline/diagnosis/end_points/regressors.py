"""Causes that move end points apart or sideways, in the few shapes that end points can distinguish."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.direction_asymmetry import ASYMMETRY
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION, SINGLE
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING, LAWS
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import EndPoints
from flexspline.pipeline.diagnosis.prediction import Prediction

HARDENING_SHAPES = tuple(
    {"law": LAWS[law], "parameter": parameter}
    for law, parameter in (
        ("knee", 0.2), ("knee", 0.45), ("knee", 0.8), ("tanh", 0.35), ("cubic", 1.0),
        ("rational", 0.1), ("rational", 0.3), ("rational", 1.0),
    )
)  # fmt: skip
"""Few of `stiffness_hardening`'s shapes, early and late bends of each: ends at some torques show whether
the twist levels off, not how. They are not refined, so they reach further than its LIMITS."""
HELD = (0, 2)
"""Stiffness as simulated at full load, or near zero."""
FRICTION_SHARES = (0.04, 0.3, 0.6)
"""Thresholds over the largest torque. Judgement: end points cannot tell nearer ones apart."""
SIDES = (-1.0, 1.0)
"""Torque raised to ±T leaves friction holding back; torque come down to ±T, holding forward."""


@dataclass(frozen=True)
class EndPointRegressor:
    """One hypothesis: a column for the totals or the mid positions of the rows.

    Attributes
    ----------
    cause : its id. channel : "total" or "mid". column : (n,) arcsec per unit of amplitude.
    spread : prior standard deviation of the amplitude. positive : whether physics forbids less than 0.
    element : an element with amplitude 1, for models.
    """

    cause: str
    channel: str
    column: np.ndarray
    spread: float
    positive: bool
    element: Element

    def of(self, unit_rows: np.ndarray) -> EndPointRegressor:
        """The same of one unit alone; `unit_rows` (n,) mask."""
        return replace(self, column=np.where(unit_rows, self.column, 0.0))

    def elements(self, amplitude: float) -> tuple[Element, ...]:
        """The cause's elements at an amplitude."""
        return (Element(self.element.shape, tuple(a * amplitude for a in self.element.amplitudes)),)


def rig_of(points: EndPoints, prediction: Prediction) -> FitContext:
    """A rig that goes straight to +T and to −T of every row."""
    largest = float(points.torque_Nm.max())
    return FitContext(prediction, History.course(np.array([largest, -largest])))


def end_point_regressors(points: EndPoints, rig: FitContext) -> list[EndPointRegressor]:
    """All hypotheses for a file's rows."""
    torque, largest = points.torque_Nm, rig.largest_Nm
    ones = np.ones_like(torque)
    clearance, series = known_causes()[CLEARANCE], known_causes()[SERIES]
    hardening, asymmetry = (
        known_causes()[HARDENING],
        known_causes()[ASYMMETRY],
    )
    friction = known_causes()[FRICTION]
    regressors = [
        EndPointRegressor(clearance.id, "total", ones, clearance.spread({}, rig), False, Element({}, (1.0,))),
        EndPointRegressor(series.id, "total", 2 * torque, series.spread({}, rig), False, Element({}, (1.0,))),
        EndPointRegressor(asymmetry.id, "mid", torque, asymmetry.spread({}, rig), False,
             Element({"exponent": 1.0, "rounding_Nm": 0.0, "largest_torque_Nm": largest}, (1.0,))),
    ]  # fmt: skip
    for law in HARDENING_SHAPES:
        for held in HELD:
            shape = {**law, "held": held, "largest_torque_Nm": largest}
            regressors.append(EndPointRegressor(
                hardening.id, "total", 2 * _at(hardening, shape, torque), hardening.spread(shape, rig),
                True, Element(shape, (1.0,)),
            ))  # fmt: skip
    for share in FRICTION_SHARES:
        shape = {
            "threshold_Nm": share * largest, "spread": SINGLE, "loaded": 0, "held": 1, "start": 0,
            "largest_torque_Nm": largest, "deadband_Nm": 0.0,
        }  # fmt: skip
        width = 2 * np.minimum(1.0, torque / (share * largest))
        for side in SIDES:
            regressors.append(EndPointRegressor(
                friction.id, "total", side * width, friction.spread(shape, rig), True,
                Element(shape, (1.0,)),
            ))  # fmt: skip
    return regressors


def _at(cause: Cause, shape: Shape, torque: np.ndarray) -> np.ndarray:
    return cause.columns(shape, History.course(torque))[:, 0]
