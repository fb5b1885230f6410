"""Where the gap is crossed: the only place that shows a shifted torque reading.

Naming causes leaves these rows out, because the side of the gap is not known there to the width of
the torque noise. Here they answer one question, with everything else as already fitted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import erf

from flexspline.pipeline.diagnosis.robust import SIGMA_PER_MAD

OFFSET_REACH = 0.35
"""Offsets searched, as a share of the largest torque."""
INSIDE_SHARE = 0.9
"""Of OFFSET_REACH: offsets tried, so that rows lie on both sides of each."""
OFFSET_STEPS = 141
"""Odd, so that one of the offsets tried is 0; the best is refined between its neighbours."""
CROSSING_WIDTHS = (0.5, 1.0, 2.0, 4.0)
"""Width of the crossing, in units of the torque noise."""
MISFIT_RATIO = 1.5
"""Times the scatter beside the gap: noise is at least this, where the model misses more than noise."""
UNSEEN_SIGMAS = 3.0
"""Standard deviations of the torque noise: an offset within is none."""
EACH_WAY, FEWEST_EACH_WAY = 0.3, 4
"""Share of the largest torque that must be passed both ways, by so many rows each."""
UNSURE = 0.7
"""Of the variance (gap/2)²(1 − side²) of a row that lies on either side. Between 0.4 and 1 it hardly matters:
of 60 made-up crossings (gap 72 arcsec, rows 0.033 N·m apart) the offset's error has an rms of 2.2 to 2.3 of
the likelihood's deviation, which is too small where rows are as sparse as that: UNIFORM_DEVIATION."""
UNIFORM_DEVIATION = 0.29
"""Of the torque between the two rows next to a crossing, the deviation of a place anywhere between: 1/√12."""
SEEN_RATIO = 2.0
"""Times one reading's noise that a gap must be to show where it is crossed: less drowns in it."""
WITHIN_GAP = 0.25
"""Of the gap, from its middle: a row there lies in the gap, which is then crossed at its torque."""
FAR_BEHIND = 4.5
"""Nats: an offset three deviations from the best one is so much less likely."""
FINE_STEPS, AT_ROW = 81, 25
"""Offsets tried between those that are far behind, and across one crossing's width: a quarter of it apart."""
UNSEEN_STEPS = 9
"""Offsets within the torque's noise, each of which counts as none: a quarter of its reach apart."""
LEAST_WIDTH = 1e-4
"""Of the largest torque: a crossing without torque noise has this width, below any torque cell's digits."""
SPIKE_REACH = 6.0
"""Times the noise, beside twice the gap, over which a row may lie that the crossing's model does not claim:
three deviations either way."""
OUTLIER_SHARE = 0.01
"""Rows that the crossing's model does not claim."""


@dataclass(frozen=True)
class Crossing:
    """Offset of the torque reading [N·m] with its standard deviation, and nats over no offset."""

    offset_Nm: float
    std_Nm: float
    nats: float


def crossing(
    torque_Nm: np.ndarray,
    left_arcsec: np.ndarray,
    gap_arcsec: float,
    noise_arcsec: float,
    torque_noise_Nm: float,
) -> Crossing | None:
    """Find the offset from rows near zero torque.

    Parameters
    ----------
    torque_Nm : (n,) readings. left_arcsec : (n,) measured angle less everything but the gap; what an
        offset does to the twist itself is in the zero, which is free.

    Returns None where the gap is too small to see, or no rows lie near zero.
    """
    largest = float(np.abs(torque_Nm).max())
    if gap_arcsec < SEEN_RATIO * noise_arcsec or largest == 0:
        return None
    if not both_ways(torque_Nm):
        return None
    near = np.abs(torque_Nm) < OFFSET_REACH * largest
    if not near.any():
        return None
    torque, left = torque_Nm[near], left_arcsec[near]
    # what the model misses near zero is not evidence of an offset
    beside = np.abs(np.abs(left) - gap_arcsec / 2)
    noise_arcsec = max(noise_arcsec, MISFIT_RATIO * SIGMA_PER_MAD * float(np.median(beside)))
    floor = max(torque_noise_Nm, LEAST_WIDTH * largest)
    even = np.linspace(-OFFSET_REACH, OFFSET_REACH, OFFSET_STEPS) * largest * INSIDE_SHARE
    inside = torque[np.abs(left) < WITHIN_GAP * gap_arcsec]
    offsets = np.union1d(even, np.round(inside / floor) * floor)

    def likelihood(places: np.ndarray, width: float) -> np.ndarray:
        """(n,) log likelihood of each offset."""
        return np.array(
            [_log_likelihood(o, width, torque, left, gap_arcsec, noise_arcsec) for o in places]
        )

    table = np.array([likelihood(offsets, w * floor) for w in CROSSING_WIDTHS])
    w, k = divmod(int(table.argmax()), len(offsets))
    width = CROSSING_WIDTHS[w] * floor
    fine = _between(offsets, table[w], k, width)
    along = likelihood(fine, width)
    # an offset within the torque's noise is none
    unseen = max(UNSEEN_SIGMAS * torque_noise_Nm, even[1] - even[0]) * np.linspace(
        -1, 1, UNSEEN_STEPS
    )
    none = max(likelihood(unseen, x * floor).max() for x in CROSSING_WIDTHS)
    weight = np.exp(along - along.max()) * np.gradient(fine)
    mean = float(weight @ fine / weight.sum())
    spread = float(weight @ (fine - mean) ** 2 / weight.sum())
    between = UNIFORM_DEVIATION * between_rows(torque_Nm, mean)
    return Crossing(mean, max(float(np.sqrt(spread)), between), float(along.max() - none))


def _between(offsets: np.ndarray, nats: np.ndarray, best: int, width: float) -> np.ndarray:
    """(m,) offsets around the best one of a table, out to those that are `FAR_BEHIND`.

    Between two rows the step may lie anywhere: all places there are as good.
    """
    behind = nats < nats[best] - FAR_BEHIND
    lower, upper = np.flatnonzero(behind[:best]), np.flatnonzero(behind[best:])
    low = offsets[lower[-1]] if len(lower) else offsets[0]
    high = offsets[best + upper[0]] if len(upper) else offsets[-1]
    at_row = offsets[best] + width * np.linspace(-UNSEEN_SIGMAS, UNSEEN_SIGMAS, AT_ROW)
    return np.union1d(np.linspace(low, high, FINE_STEPS), at_row.clip(low, high))


def between_rows(torque_Nm: np.ndarray, place_Nm: float, nearest: int = 1) -> float:
    """Torque [N·m] between the `nearest` rows on either side of a place, of all crossings together.

    Cycles whose rows stand at other torques narrow it.
    """
    below, above = torque_Nm[torque_Nm < place_Nm], torque_Nm[torque_Nm > place_Nm]
    if min(len(below), len(above)) < nearest:
        return float(np.ptp(torque_Nm))
    after = np.partition(above, nearest - 1)[nearest - 1]
    return float(after + np.partition(-below, nearest - 1)[nearest - 1])


def both_ways(torque_Nm: np.ndarray) -> bool:
    """Whether the torque goes far enough to both sides for a step between them to have a place."""
    far = EACH_WAY * np.abs(torque_Nm).max()
    return bool(min((torque_Nm > far).sum(), (torque_Nm < -far).sum()) >= FEWEST_EACH_WAY)


def _log_likelihood(
    offset: float, width: float, torque: np.ndarray, left: np.ndarray, gap: float, noise: float
) -> float:
    side = erf((torque - offset) / (np.sqrt(2) * width))
    variance = noise**2 + (gap / 2) ** 2 * (1 - side**2) * UNSURE
    off = (left - gap / 2 * side) ** 2 / variance
    # a row that the model does not claim lies anywhere over twice the gap
    own = np.log(1 - OUTLIER_SHARE) - off / 2 - np.log(2 * np.pi * variance) / 2
    other = np.log(OUTLIER_SHARE / (2 * gap + SPIKE_REACH * noise))
    return float(np.logaddexp(own, other).sum())
