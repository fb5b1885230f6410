"""How far the clearance opened by bearing play may be off, up to the end of the model."""

from __future__ import annotations

from math import erfc, radians, sin, sqrt

import numpy as np

from flexspline.geometry.design import Bearing, Gear
from flexspline.pipeline.bearing_play import involute_clearance, play_limit

REACH = 8.0
"""Standard deviations on each side that are integrated: beyond lies 1e-15 of the probability."""
NODES = 48
"""Gauss-Legendre points: 1e-8 of the result, also against the root at c_max."""


def play_spread(gear: Gear, bearing: Bearing, play_std_um: float) -> tuple[float, float]:
    """Standard deviation of the normal clearance j′ [mm], and the probability that c > c_max.

    Small-displacement model: s·sin α, exactly. Involute model: the root mean square of
    j′(C) − j′(c) for C normal about c with deviation s, given C ≤ c_max. Far from c_max that is the
    linear s·sin α′. At c_max the slope sin α′ vanishes and a linear rule would claim certainty; the
    integral does not. C beyond c_max has no answer in this model: it is left out, and its
    probability is returned instead of being hidden. C below 0 is preload, which the formula covers.
    """
    s = play_std_um * 1e-3
    alpha = radians(gear.pressure_angle_deg)
    if s == 0.0:
        return 0.0, 0.0
    if bearing.bearing_play_model == "small_displacement":
        return s * sin(alpha), 0.0
    a = gear.centre_distance_mm
    play, limit = bearing.radial_clearance_um * 1e-3, play_limit(a, alpha)
    top = min(REACH, (limit - play) / s)
    x, w = np.polynomial.legendre.leggauss(NODES)
    t = -REACH + (top + REACH) * (x + 1) / 2
    density = w * np.exp(-t * t / 2)
    here = involute_clearance(play, a, alpha)
    off = np.array([involute_clearance(play + s * ti, a, alpha) - here for ti in t])
    spread = sqrt(float(density @ off**2 / density.sum()))
    return spread, 0.5 * erfc((limit - play) / s / sqrt(2))
