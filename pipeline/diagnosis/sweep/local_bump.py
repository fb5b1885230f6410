"""Where the curve over the torque has bumps, if it has any: before anything else is fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.measurement.history import History

PLACE_SHARE = 0.01
"""Of the largest torque, between places that are tried: a third of the narrowest bump."""
WIDTH_SHARES = (0.03, 0.04, 0.05, 0.065, 0.08, 0.1, 0.13)
"""Of the largest torque, half widths at 1/e of the height. Narrower ones are a few rows; wider ones are what
smooth functions of torque and a soft wind-up can be."""
CLEAR_WIDTHS = 1.5
"""Between a bump and the largest torque, or the gap: beyond them its other flank is not seen."""
FEWEST_TORQUES = 5
"""Different torques, `PLACE_SHARE` apart, on a bump: fewer draw no shape."""
ON_BUMP = 0.3
"""Of its height, where a row is on it."""
MOST_BUMPS = 2
"""Of a record: a tooth on either flank, or two teeth."""
LEAST_NEW_SHARE = 0.05
"""Of a bump's own square: one of which less is new beside the smooth functions is one of them."""
BASIS_RATIO = 1e-6
"""Of the largest singular value: a smooth function below it is one of the others."""


@dataclass(frozen=True)
class Bump:
    """A bump of the curve, exp(−((T − place)/width)²), whatever the direction of loading.

    `near_Nm` : where it is said to be; one on another's flank is a part of that one.
    """

    place_Nm: float
    width_Nm: float
    near_Nm: float

    def of(self, torque_Nm: np.ndarray) -> np.ndarray:
        """(n,) of height 1."""
        return np.exp(-(((torque_Nm - self.place_Nm) / self.width_Nm) ** 2))


def local_bumps(history: History, angle_arcsec: np.ndarray, kept: np.ndarray) -> tuple[Bump, ...]:
    """The bumps on one side of zero that explain most beside smooth functions, each beside those before it.

    Parameters
    ----------
    angle_arcsec : (n,) measured less simulated angle. kept : (n,) rows that count.

    As `zero_jump.py` does for steps. `MOST_BUMPS` at most, none where none can be told.
    """
    rows = np.flatnonzero(kept)
    x = history.torque_Nm[rows] / history.largest_Nm
    zeros = history.unit[rows, None] == np.unique(history.unit[rows])
    direction = direction_of_loading(history)[rows]
    powers = [x, np.abs(x), x * np.abs(x), x**3, np.sign(x), direction, direction * x]
    smooth, largest = np.column_stack([zeros, *powers]), history.largest_Nm
    found: list[Bump] = []
    for _ in range(MOST_BUMPS):
        best = _best(x, angle_arcsec[rows], smooth)
        if best is None:
            break
        place, width = best
        found.append(_beside(found, place * largest, width * largest))
        smooth = np.column_stack([smooth, found[-1].of(x * largest)])
    return tuple(found)


def _beside(found: Sequence[Bump], place_Nm: float, width_Nm: float) -> Bump:
    for other in found:
        if abs(place_Nm - other.place_Nm) < width_Nm + other.width_Nm:
            return Bump(place_Nm, width_Nm, other.near_Nm)
    return Bump(place_Nm, width_Nm, place_Nm)


def _best(
    x: np.ndarray, angle_arcsec: np.ndarray, beside: np.ndarray
) -> tuple[float, float] | None:
    """Place and width of the best one beside columns (n, k), in shares of the largest torque as torques x.

    A bump b takes (bᵀr)²/(bᵀb − |Qᵀb|²) off the sum of squares, with what the columns' orthonormal basis Q
    leaves, r. Rows of one torque, to `PLACE_SHARE`, count together.
    """
    basis, size, _ = np.linalg.svd(beside, full_matrices=False)
    basis = basis[:, size > BASIS_RATIO * size[0]]
    left = angle_arcsec - basis @ (basis.T @ angle_arcsec)
    torques, at = np.unique(np.round(x / PLACE_SHARE).astype(int), return_inverse=True)
    count = np.bincount(at)
    of_left = np.bincount(at, left)
    of_basis = np.column_stack([np.bincount(at, column) for column in basis.T])
    best: float = 0.0
    found: tuple[float, float] | None = None
    for width in WIDTH_SHARES:
        places = np.arange(CLEAR_WIDTHS * width, 1 - CLEAR_WIDTHS * width, PLACE_SHARE)
        places = np.concatenate([-places, places])
        height = np.exp(-(((torques * PLACE_SHARE - places[:, None]) / width) ** 2))
        own = height**2 @ count
        new = own - ((height @ of_basis) ** 2).sum(axis=1)
        told = ((height > ON_BUMP).sum(axis=1) >= FEWEST_TORQUES) & (new > LEAST_NEW_SHARE * own)
        gain = np.where(told, (height @ of_left) ** 2 / np.where(told, new, 1.0), 0.0)
        if gain.max() > best:
            best, found = float(gain.max()), (float(places[gain.argmax()]), width)
    return found
