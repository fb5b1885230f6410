"""A first guess of a shifted torque reading, before anything is fitted.

A large offset puts rows on the wrong side of the gap far outside the crossing's band, and would pass for
other causes.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.robust import SIGMA_PER_MAD
from flexspline.pipeline.diagnosis.sweep.torque_offset import REACH, both_ways

MOST_ZEROS = 40
"""Cycles with a zero of their own each; where there are more, each unit has one."""
MOST_FIRST_ROWS = 3000
"""Rows of a first guess, evenly chosen: a longer record costs no more."""
BESIDE_BAND = 0.3
"""Of the crossing's band, 1.2σ or more of the torque's noise: nearer rows may lie on either side."""
LEAST_STEP = 0.15
"""Of the gap as simulated: a smaller step is not the gap."""
DEPENDENT = 4.0
"""Neighbouring rows that count as one: a smooth function misses them alike."""
FIRST_STEPS = 81
"""Places tried: odd, so that 0 is one; 0.9 % of the largest torque apart, a quarter of the band (3.5 %)."""
FIRST_NATS = 12.0
"""Over no offset, odds of 160 000 to 1: a guess that is wrong costs a whole race."""
SINGULAR = 1e-12
"""Of the normal equations' largest eigenvalue: functions that are one but for 1e-6 share their coefficient.
The equations take a fifth of the time of a decomposition of 3000 rows, and a guess needs no more digits."""
ROBUST = 4.0
"""Standard deviations: beyond, a row weighs less (Huber's weights); of normal noise, one row in 16 000."""


def first_offset(
    history: History, angle_arcsec: np.ndarray, gap_arcsec: float, band_Nm: float
) -> float:
    """The guess [N·m]; 0 where there is none to see.

    The angle is fitted by smooth functions of torque and direction and one
    step of free height; the step's place is the guess, if it is clearly better there than at zero.
    """
    largest = float(np.abs(history.torque_Nm).max())
    if not both_ways(history.torque_Nm):
        return 0.0
    x = history.torque_Nm / largest
    direction = direction_of_loading(history)
    # a zero for each cycle: position errors and drift would else hide the step
    key = history.unit * (int(history.cycle.max()) + 1) + history.cycle
    if len(np.unique(key)) > MOST_ZEROS:
        key = history.unit
    units = [(key == k).astype(float) for k in np.unique(key)]
    smooth = np.column_stack([*units, x, np.abs(x), x**2, x**3, direction, direction * x**2])
    step = max(1, len(x) // MOST_FIRST_ROWS)
    places = np.linspace(-REACH, REACH, FIRST_STEPS) * largest

    def misfit(place: float) -> float:
        far = np.abs(history.torque_Nm - place) > BESIDE_BAND * band_Nm
        rows = np.flatnonzero(far)[::step]
        side = np.sign(history.torque_Nm[rows] - place)
        basis = np.column_stack([smooth[rows], side])
        weight = np.ones(len(rows))
        left = angle_arcsec[rows]
        for _ in range(2):
            weighted = basis * weight[:, None]
            found = np.linalg.lstsq(
                weighted.T @ weighted, weighted.T @ (angle_arcsec[rows] * weight), rcond=SINGULAR
            )[0]
            left = angle_arcsec[rows] - basis @ found
            scale = SIGMA_PER_MAD * np.median(np.abs(left)) + 1e-9
            weight = 1 / np.maximum(1, np.abs(left) / (ROBUST * scale))
        if found[-1] < LEAST_STEP * gap_arcsec:
            return np.inf
        return float(np.mean(np.minimum(np.abs(left), 2 * gap_arcsec) ** 2)) * len(rows)

    table = np.array([misfit(p) for p in places])
    at_zero = misfit(0.0)
    best = int(np.argmin(table))
    count = len(x) / step
    if not np.isfinite(table[best]) or table[best] <= 0:
        return 0.0
    nats = count / 2 * np.log(at_zero / table[best]) / DEPENDENT
    if abs(places[best]) < band_Nm / 2 or nats < FIRST_NATS:
        return 0.0
    return float(places[best])
