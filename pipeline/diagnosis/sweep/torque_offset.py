"""Where the gap is crossed: the only place that shows a shifted torque reading.

Naming causes leaves these rows out, because the side of the gap is not known there to the width of
the torque noise. Here they answer one question, with everything else as already fitted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import erf

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.robust import SIGMA_PER_MAD

REACH = 0.35
"""Offsets searched, as a share of the largest torque."""
STEPS = 141
"""Odd, so that one of the offsets tried is 0; the best is refined between its neighbours."""
WIDTHS = (0.5, 1.0, 2.0, 4.0)
"""Width of the crossing, in units of the torque noise."""
MISFIT = 1.5
"""Times the scatter beside the gap: noise is at least this, where the model misses more than noise."""
UNSEEN = 3.0
"""Standard deviations of the torque noise: an offset within is none."""
EACH_WAY, FEWEST_EACH_WAY = 0.3, 4
"""Share of the largest torque that must be passed both ways, by so many rows each."""
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
    if gap_arcsec < 2 * noise_arcsec or largest == 0:
        return None
    if not both_ways(torque_Nm):
        return None
    near = np.abs(torque_Nm) < REACH * largest
    torque, left = torque_Nm[near], left_arcsec[near]
    # what the model misses near zero is not evidence of an offset
    beside = np.abs(np.abs(left) - gap_arcsec / 2)
    noise_arcsec = max(noise_arcsec, MISFIT * SIGMA_PER_MAD * float(np.median(beside)))
    offsets = np.linspace(-REACH, REACH, STEPS) * largest * 0.9
    floor = max(torque_noise_Nm, 1e-4 * largest)
    best = [
        np.array(
            [_log_likelihood(o, w * floor, torque, left, gap_arcsec, noise_arcsec) for o in offsets]
        )
        for w in WIDTHS
    ]
    table = np.array(best)
    w, k = divmod(int(table.argmax()), STEPS)
    fine = np.linspace(offsets[max(0, k - 1)], offsets[min(STEPS - 1, k + 1)], 81)
    along = np.array(
        [
            _log_likelihood(o, WIDTHS[w] * floor, torque, left, gap_arcsec, noise_arcsec)
            for o in fine
        ]
    )
    # an offset within the torque's noise is none
    unseen = max(UNSEEN * torque_noise_Nm, offsets[1] - offsets[0]) * np.linspace(-1, 1, 9)
    none = max(
        _log_likelihood(o, x * floor, torque, left, gap_arcsec, noise_arcsec)
        for o in unseen
        for x in WIDTHS
    )
    weight = np.exp(along - along.max())
    mean = float(weight @ fine / weight.sum())
    std = float(np.sqrt(weight @ (fine - mean) ** 2 / weight.sum() + (fine[1] - fine[0]) ** 2 / 12))
    return Crossing(mean, std, float(along.max() - none))


def both_ways(torque_Nm: np.ndarray) -> bool:
    """Whether the torque goes far enough to both sides for a step between them to have a place."""
    far = EACH_WAY * np.abs(torque_Nm).max()
    return bool(min((torque_Nm > far).sum(), (torque_Nm < -far).sum()) >= FEWEST_EACH_WAY)


def _log_likelihood(
    offset: float, width: float, torque: np.ndarray, left: np.ndarray, gap: float, noise: float
) -> float:
    side = erf((torque - offset) / (np.sqrt(2) * width))
    variance = noise**2 + (gap / 2) ** 2 * (1 - side**2) * 0.7
    off = (left - gap / 2 * side) ** 2 / variance
    # a row that the model does not claim lies anywhere over twice the gap
    own = np.log(1 - OUTLIER_SHARE) - off / 2 - np.log(2 * np.pi * variance) / 2
    other = np.log(OUTLIER_SHARE / (2 * gap + 6 * noise))
    return float(np.logaddexp(own, other).sum())


MOST_ZEROS = 40
"""Cycles with a zero of their own each; where there are more, each unit has one."""
FIRST_STEPS = 81
"""Places tried: odd, so that 0 is one; 0.9 % of the largest torque apart, a quarter of the band (3.5 %)."""
FIRST_NATS = 12.0
"""Over no offset, odds of 160 000 to 1: a guess that is wrong costs a whole race."""
ROBUST = 4.0
"""Standard deviations: beyond, a row weighs less (Huber's weights); of normal noise, one row in 16 000."""


def first_offset(
    history: History, angle_arcsec: np.ndarray, gap_arcsec: float, band_Nm: float
) -> float:
    """A first guess of the offset [N·m], before anything is fitted; 0 where there is none to see.

    A large offset puts rows on the wrong side of the gap far outside the crossing's band, and would
    pass for other causes. The angle is fitted by smooth functions of torque and direction and one
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
    step = max(1, len(x) // 3000)
    places = np.linspace(-REACH, REACH, FIRST_STEPS) * largest

    def misfit(place: float) -> float:
        far = np.abs(history.torque_Nm - place) > 0.3 * band_Nm
        rows = np.flatnonzero(far)[::step]
        side = np.sign(history.torque_Nm[rows] - place)
        basis = np.column_stack([smooth[rows], side])
        weight = np.ones(len(rows))
        left = angle_arcsec[rows]
        for _ in range(2):
            found = np.linalg.lstsq(
                basis * weight[:, None], angle_arcsec[rows] * weight, rcond=None
            )[0]
            left = angle_arcsec[rows] - basis @ found
            scale = SIGMA_PER_MAD * np.median(np.abs(left)) + 1e-9
            weight = 1 / np.maximum(1, np.abs(left) / (ROBUST * scale))
        if found[-1] < 0.15 * gap_arcsec:
            return np.inf
        return float(np.mean(np.minimum(np.abs(left), 2 * gap_arcsec) ** 2)) * len(rows)

    table = np.array([misfit(p) for p in places])
    at_zero = misfit(0.0)
    best = int(np.argmin(table))
    count = len(x) / step
    if not np.isfinite(table[best]) or table[best] <= 0:
        return 0.0
    nats = count / 2 * np.log(at_zero / table[best]) / 4  # neighbours are not independent
    if abs(places[best]) < band_Nm / 2 or nats < FIRST_NATS:
        return 0.0
    return float(places[best])
