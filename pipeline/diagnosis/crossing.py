"""Where the gap is crossed: the only place that shows a shifted torque reading.

Naming causes leaves these rows out, because the side of the gap is not known there to the width of
the torque noise. Here they answer one question, with everything else as already fitted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import erf

REACH = 0.35
"""Offsets searched, as a share of the largest torque."""
STEPS = 141
WIDTHS = (0.5, 1.0, 2.0, 4.0)
"""Width of the crossing, in units of the torque noise."""
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
    slope: float,
) -> Crossing | None:
    """Find the offset from rows near zero torque.

    Parameters
    ----------
    torque_Nm : (n,) readings. left_arcsec : (n,) measured angle less everything but the gap.
    slope : compliance [arcsec per N·m]: an offset o also lowers the twist by slope·o, which the zero
        has absorbed as fitted far from the crossing.

    Returns None where the gap is too small to see, or no rows lie near zero.
    """
    largest = float(np.abs(torque_Nm).max())
    if gap_arcsec < 2 * noise_arcsec or largest == 0:
        return None
    near = np.abs(torque_Nm) < REACH * largest
    torque, left = torque_Nm[near], left_arcsec[near]
    offsets = np.linspace(-REACH, REACH, STEPS) * largest * 0.9
    floor = max(torque_noise_Nm, 1e-4 * largest)
    best = [
        np.array([_log_likelihood(o, w * floor, torque, left, gap_arcsec, noise_arcsec) for o in offsets])
        for w in WIDTHS
    ]
    table = np.array(best)
    w, k = np.unravel_index(table.argmax(), table.shape)
    fine = np.linspace(offsets[max(0, k - 1)], offsets[min(STEPS - 1, k + 1)], 81)
    along = np.array([
        _log_likelihood(o, WIDTHS[w] * floor, torque, left, gap_arcsec, noise_arcsec) for o in fine
    ])
    none = max(_log_likelihood(0.0, x * floor, torque, left, gap_arcsec, noise_arcsec) for x in WIDTHS)
    weight = np.exp(along - along.max())
    mean = float(weight @ fine / weight.sum())
    std = float(np.sqrt(weight @ (fine - mean) ** 2 / weight.sum() + (fine[1] - fine[0]) ** 2 / 12))
    return Crossing(mean, std, float(along.max() - none))


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
