"""A first guess of a shifted torque reading, before anything is fitted.

A large offset puts rows on the wrong side of the gap far outside the crossing's band, and would pass for
other causes.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.crossing.gap_crossing import (
    OFFSET_REACH,
    SEEN_RATIO,
    on_both_sides,
)
from flexspline.pipeline.diagnosis.sweep.crossing.step_fit import (
    StepFit,
    changing_heights,
    nats_over,
    rows_judged,
    stiffness_of_positions,
    zeros_of_cycles,
)

FIRST_STEPS = 81
"""Places tried: odd, so that 0 is one; 0.9 % of the largest torque apart, a quarter of the band (3.5 %)."""
FIRST_NATS = 12.0
"""Over no offset, odds of 160 000 to 1: a guess that is wrong costs a whole race."""


def first_offset(
    history: History, angle_arcsec: np.ndarray, gap_arcsec: float, band_Nm: float
) -> float:
    """The guess [N·m]; 0 where there is none to see.

    The angle is fitted by smooth functions of torque and direction, a stiffness of each position's and one
    step of free height; the step's place is the guess, if it is clearly better there than at zero, and if the
    functions leave less than the step: what they miss of a loop without a step is better at some place too.
    """
    largest = history.largest_Nm
    if not on_both_sides(history.torque_Nm):
        return 0.0
    x = history.torque_Nm / largest
    direction = direction_of_loading(history)
    zeros = zeros_of_cycles(history)
    positions = stiffness_of_positions(history)
    smooth = np.column_stack(
        [*zeros, positions, x, np.abs(x), x**2, x**3, direction, direction * x**2]
    )
    step = StepFit(smooth, angle_arcsec, gap_arcsec, band_Nm, changing_heights(history))
    places = np.linspace(-OFFSET_REACH, OFFSET_REACH, FIRST_STEPS) * largest

    def misfit(place: float) -> float:
        return step.misfit(history.torque_Nm - place)

    table = np.array([misfit(p) for p in places])
    at_zero = misfit(0.0)
    best = int(np.argmin(table))
    if not np.isfinite(table[best]) or table[best] <= 0:
        return 0.0
    left_arcsec = np.sqrt(table[best] / rows_judged(len(x)))
    if gap_arcsec < SEEN_RATIO * left_arcsec:
        return 0.0
    nats = nats_over(at_zero, table[best], len(x))
    if abs(places[best]) < band_Nm / 2 or nats < FIRST_NATS:
        return 0.0
    return float(places[best])
