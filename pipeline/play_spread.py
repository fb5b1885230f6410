"""Bearing play as a random variable, and the uncertainty of the clearance that it opens.

Play is normal about the stated clearance, and cut off at c_max, where the involute model ends.
"""

from __future__ import annotations

from math import erfc, inf, radians, sin, sqrt

import numpy as np

from flexspline.geometry.design import Bearing, Gear
from flexspline.geometry.fields import MM_PER_UM
from flexspline.pipeline.bearing_play import involute_clearance

PLAY_SIGMAS = 8.0
"""Standard deviations on each side that are integrated: beyond lies 1e-15 of the probability."""
PLAY_NODES = 48
"""Gauss-Legendre points: 1e-8 of the result, also against the root at c_max."""


def play_distribution(
    gear: Gear,
    bearing: Bearing,
    play_std_um: float,
    reach: float = PLAY_SIGMAS,
    nodes: int = PLAY_NODES,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the play's truncated normal as a quadrature: steps (k,) in standard deviations, weights (k,).

    Weights sum to 1; no step leads beyond c_max. The small-displacement model has no end, so its
    normal is whole. `play_std_um` above 0; `reach` standard deviations on each side are covered.
    """
    top = min(reach, _steps_to_end(gear, bearing, play_std_um))
    x, w = np.polynomial.legendre.leggauss(nodes)
    steps = -reach + (top + reach) * (x + 1) / 2
    density = w * np.exp(-(steps**2) / 2)
    return steps, density / density.sum()


def _steps_to_end(gear: Gear, bearing: Bearing, play_std_um: float) -> float:
    """Standard deviations from c to c_max; inf for the small-displacement model."""
    if bearing.bearing_play_model == "small_displacement":
        return inf
    return (gear.bearing_play_limit_um - bearing.radial_clearance_um) / play_std_um


def play_spread(gear: Gear, bearing: Bearing, play_std_um: float) -> tuple[float, float]:
    """Return the standard deviation of the clearance j′ [mm], and the probability that c > c_max.

    Small-displacement model: s·sin α, exactly. Involute model: the root mean square of
    j′(C) − j′(c) for C normal about c with deviation s, given C ≤ c_max. Far from c_max that is the
    linear s·sin α′. At c_max the slope sin α′ vanishes and a linear rule would claim certainty; the
    integral does not. C beyond c_max has no answer in this model: it is left out, and its
    probability is returned instead of being hidden. C below 0 is preload, which the formula covers.
    """
    s = play_std_um * MM_PER_UM
    alpha = radians(gear.pressure_angle_deg)
    if s == 0.0:
        return 0.0, 0.0
    if bearing.bearing_play_model == "small_displacement":
        return s * sin(alpha), 0.0
    a, play = gear.centre_distance_mm, bearing.radial_clearance_mm
    steps, weight = play_distribution(gear, bearing, play_std_um)
    nominal = involute_clearance(play, a, alpha)
    off = np.array([involute_clearance(play + s * t, a, alpha) - nominal for t in steps])
    beyond = 0.5 * erfc(_steps_to_end(gear, bearing, play_std_um) / sqrt(2))
    return sqrt(float(weight @ off**2)), beyond
