"""An angle reading that drifts with time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.measurement.history import History

DRIFT = "sensor_drift"
"""This cause's id."""
SATURATION = (0.2, 0.5, 1.2)
"""Settling times over the record's duration; they are refined. Judgement: about a factor of 2.5 apart."""
EXPONENTS = (1.0, 0.5, 1.6)
"""Exponents of time: steady, slowing as √t, quickening; they are refined."""
LEAST_EXPONENT, MOST_EXPONENT = 0.35, 2.0
"""Of time, when refined: below, half of the drift is over in the first seventh of the record, as after a jump
at its start; above, half of it comes in the last third, as before a jump at its end."""
LEAST_SETTLING = 0.2
"""Of the record, when refined: half of the drift is over in its first seventh, as at the least exponent."""
SECONDS_PER_HOUR = 3600.0
"""The magnitude is per hour, time is in s."""


class SensorDrift(Cause):
    """Angle d·g(t) with d [arcsec] and g from 0 at the start to 1 after `duration_s`.

    Steady, slowing (a power of time, or saturating with `settling_s`), or quickening.
    """

    id = DRIFT
    title = "drift of the angle reading"
    unit = "arcsec/h"
    spread_share = 0.4
    """A reading may drift by as much as the gear twists; nothing limits it."""
    tunable = ("exponent", "settling_s")
    shape_doubt = 0.017
    """One and two deviations cover 68 and 84 % of 19 sizes."""
    vary = "time_s"
    needs_time = True
    shows_over = "time_s"
    reveals = "the same torque held, or returned to, over hours with the wave generator untouched"

    def shapes(self, rig: FitContext) -> list[Shape]:
        if rig.duration_s <= 0:
            return []
        d = rig.duration_s
        shapes: list[Shape] = [
            {"exponent": n, "settling_s": 0.0, "duration_s": d} for n in EXPONENTS
        ]
        shapes += [{"exponent": 1.0, "settling_s": s * d, "duration_s": d} for s in SATURATION]
        return shapes

    def possible(self, shape: Shape) -> bool:
        settling = shape["settling_s"] / shape["duration_s"]
        slow_enough = settling == 0.0 or settling >= LEAST_SETTLING
        return LEAST_EXPONENT <= shape["exponent"] <= MOST_EXPONENT and slow_enough

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        if history.time_s is None:
            raise ValueError("drift needs time")
        t = history.time_s.astype(float)
        for rows in history.unit_slices:
            t[rows] -= t[rows[0]]
        if shape["settling_s"] > 0:
            s = shape["settling_s"]
            grown = np.expm1(-t / s) / np.expm1(-shape["duration_s"] / s)
        else:
            grown = (t / shape["duration_s"]) ** shape["exponent"]
        return grown[:, None]

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        return sum(e.amplitudes[0] for e in elements) / (rig.duration_s / SECONDS_PER_HOUR)
