"""Where the curve over the torque has bumps, if it has any: before anything else is fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import exp, log

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading, stops
from flexspline.pipeline.diagnosis.measurement.history import History

PLACE_SHARE = 0.01
"""Of the largest torque, between places that are tried first: a third of the narrowest bump."""
WIDTH_SHARES = (0.03, 0.04, 0.05, 0.065, 0.08, 0.1, 0.13)
"""Of the largest torque, half widths at 1/e of the height that are tried first. Narrower ones are a few rows;
wider ones are what smooth functions of torque and a soft wind-up can be."""
CLEAR_WIDTHS = 1.5
"""Between a bump and the largest torque, or the gap: beyond them its other flank is not seen."""
AT_GAP_WIDTHS = 0.25
"""Of its width, by which a bump may lie beside the gap and show both flanks. One further off, and its mirror
image, are what a soft wind-up is."""
FEWEST_TORQUES = 5
"""Different torques, `PLACE_SHARE` apart, on a bump: fewer draw no shape."""
ON_BUMP = 0.3
"""Of its height, where a row is on it."""
MOST_BUMPS = 3
"""Of a record: a tooth on either flank or two teeth, and one more."""
PART_SHARE = 0.01
"""Of what a bump explains: one on its flank that explains less is a part of that one, whose form is none of
those tried. Corners of a triangle leave 0.002, a second bump of two thirds of the height 0.017."""
LEAST_NEW_SHARE = 0.05
"""Of a bump's own square: one of which less is new beside the smooth functions is one of them."""
BASIS_RATIO = 1e-6
"""Of the largest singular value: a smooth function below it is one of the others."""
FRICTION_SHARES = (0.015, 0.03, 0.06, 0.13, 0.25)
"""Of the largest torque, at which friction beside a bump slips."""
CLEAR_GAIN = 40.0
"""Of what the best places and widths tried leave in the mean row: a bump of less has the form tried first.
Four numbers more would fit noise by 4."""
INSIDE = 1e-9
"""Of the numbers tuned, by which they begin inside their limits: the solver begins at none."""
TUNING_ROUNDS = 60
"""Most steps by which forms are tuned. Judgement: most need ten."""
PEAKED, FLAT = 1.0, 5.0
"""Powers of a bump's form, by judgement: of exponential flanks, and a table with steep sides. A triangle has
1.5, a Gaussian 2, a raised cosine 2.3."""


@dataclass(frozen=True)
class Bump:
    """A bump of the curve, exp(−|(T − place)/width|^power), whatever the direction of loading.

    `width_Nm`, `above_Nm` : half widths below and above the place. `near_Nm` : where it is said to be; a low
    one on another's flank is a part of that one.
    """

    place_Nm: float
    width_Nm: float
    above_Nm: float
    power: float
    near_Nm: float

    def of(self, torque_Nm: np.ndarray) -> np.ndarray:
        """(n,) of height 1."""
        off = torque_Nm - self.place_Nm
        width = np.where(off < 0, self.width_Nm, self.above_Nm)
        return np.exp(-(np.abs(off / width) ** self.power))


def local_bumps(history: History, angle_arcsec: np.ndarray, kept: np.ndarray) -> tuple[Bump, ...]:
    """The bumps that explain most beside smooth functions and friction, each beside those before it.

    Parameters
    ----------
    angle_arcsec : (n,) measured less simulated angle. kept : (n,) rows that count.

    As `zero_jump.py` does for steps. `MOST_BUMPS` at most, none where none can be told. Places and widths are
    those that fit best of all tried, then tuned together with each side's width and the flanks' form.
    """
    rows, largest = np.flatnonzero(kept), history.largest_Nm
    x, y = history.torque_Nm[rows] / largest, angle_arcsec[rows]
    basis = orthonormal(beside_bumps(history, rows))
    left = y - basis @ (basis.T @ y)
    bumps: list[Bump] = []  # in shares of the largest torque
    gains: list[float] = []
    for _ in range(MOST_BUMPS):
        columns = np.column_stack([b.of(x) for b in bumps]) if bumps else np.empty((len(x), 0))
        now = np.hstack([basis, orthonormal(less(basis, columns))])
        best = _best(x, y, now)
        if best is None:
            break
        place, width, gain = best
        new = Bump(place, width, width, 2.0, place)
        near = _part_of(new, gain, bumps, gains)
        rest = y - now @ (now.T @ y)
        clear = gain > CLEAR_GAIN * max(float(rest @ rest) - gain, 0.0) / len(rest)
        if near is None and clear:
            bumps = _tuned(x, left, basis, [*bumps, new])
        else:
            bumps.append(new if near is None else replace(new, near_Nm=near))
        gains.append(gain)
    return tuple(_in_Nm(b, largest) for b in bumps)


def _in_Nm(bump: Bump, largest_Nm: float) -> Bump:
    """A bump that is in shares of the largest torque."""
    near = 0.0 if abs(bump.near_Nm) < PLACE_SHARE else bump.near_Nm * largest_Nm
    place, below, above = (
        share * largest_Nm for share in (bump.place_Nm, bump.width_Nm, bump.above_Nm)
    )
    return Bump(place, below, above, bump.power, near)


def _part_of(new: Bump, gain: float, bumps: Sequence[Bump], gains: Sequence[float]) -> float | None:
    """Where the bump is on whose flank a new one explains so little that it is a part of that one."""
    for other, explained in zip(bumps, gains, strict=True):
        reach = new.width_Nm + max(other.width_Nm, other.above_Nm)
        beside = abs(new.place_Nm - other.place_Nm) < CLEAR_WIDTHS * reach
        if beside and gain < PART_SHARE * explained:
            return other.near_Nm
    return None


def beside_bumps(history: History, rows: np.ndarray) -> np.ndarray:
    """(n, k) smooth functions of torque and direction, and friction loops that are steady or change."""
    x = history.torque_Nm / history.largest_Nm
    zeros = history.unit[:, None] == np.unique(history.unit[rows])
    direction = direction_of_loading(history)
    powers = [x, np.abs(x), x * np.abs(x), x**3, np.sign(x), direction, direction * x]
    loops = friction_loops(history)
    passed = np.arange(len(x))[:, None] / len(x)
    return np.column_stack([zeros, *powers, loops, loops * passed])[rows]


def friction_loops(history: History) -> np.ndarray:
    """(n, k) steady loops of friction, of height 1, that slip at FRICTION_SHARES of the largest torque."""
    limits = np.array(FRICTION_SHARES) * history.largest_Nm
    return np.asarray(stops(history, history.torque_Nm, limits, np.zeros(len(limits))) / limits)


def orthonormal(columns: np.ndarray) -> np.ndarray:
    """(n, r) a basis of what columns (n, k) span."""
    if not columns.shape[1]:
        return columns
    basis, size, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(basis[:, size > BASIS_RATIO * size[0]])


def less(basis: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Columns (n, k) less what an orthonormal basis can be of them."""
    return np.asarray(columns - basis @ (basis.T @ columns))


def _tuned(x: np.ndarray, left: np.ndarray, basis: np.ndarray, bumps: Sequence[Bump]) -> list[Bump]:
    """Bumps whose places, widths and forms fit best together, in shares of the largest torque."""
    from scipy.optimize import least_squares

    narrow, wide = log(WIDTH_SHARES[0] / CLEAR_WIDTHS), log(CLEAR_WIDTHS * WIDTH_SHARES[-1])
    start, low, high = [], [], []
    for b in bumps:
        reach = CLEAR_WIDTHS * max(b.width_Nm, b.above_Nm)
        start += [b.place_Nm, log(b.width_Nm), log(b.above_Nm), b.power]
        low += [b.place_Nm - reach, narrow, narrow, PEAKED]
        high += [b.place_Nm + reach, wide, wide, FLAT]

    def bumps_of(numbers: np.ndarray) -> list[Bump]:
        return [
            Bump(place, exp(below), exp(above), power, place)
            for place, below, above, power in numbers.reshape(-1, 4).tolist()
        ]

    def misfit(numbers: np.ndarray) -> np.ndarray:
        columns = less(basis, np.column_stack([b.of(x) for b in bumps_of(numbers)]))
        heights = np.linalg.lstsq(columns, left, rcond=BASIS_RATIO)[0]
        return np.asarray(left - columns @ heights)

    inside = np.clip(start, np.array(low) + INSIDE, np.array(high) - INSIDE)
    # x_scale: usual changes of place, logs of both widths, and power
    solution = least_squares(
        misfit, inside, bounds=(low, high), x_scale=[0.01, 0.1, 0.1, 0.2] * len(bumps),
        max_nfev=TUNING_ROUNDS,
    )  # fmt: skip
    return bumps_of(solution.x)


def _best(
    x: np.ndarray, angle_arcsec: np.ndarray, basis: np.ndarray
) -> tuple[float, float, float] | None:
    """Place and width of the best one, in shares of the largest torque as torques x, and what it explains.

    A bump b takes (bᵀr)²/(bᵀb − |Qᵀb|²) off the sum of squares, with what an orthonormal basis Q leaves, r.
    Rows of one torque, to `PLACE_SHARE`, count together.
    """
    left = angle_arcsec - basis @ (basis.T @ angle_arcsec)
    torques, at = np.unique(np.round(x / PLACE_SHARE).astype(int), return_inverse=True)
    count = np.bincount(at)
    of_left = np.bincount(at, left)
    of_basis = np.column_stack([np.bincount(at, column) for column in basis.T])
    best: float = 0.0
    best_bump: tuple[float, float, float] | None = None
    for width in WIDTH_SHARES:
        places = np.arange(CLEAR_WIDTHS * width, 1 - CLEAR_WIDTHS * width, PLACE_SHARE)
        beside = np.arange(0, AT_GAP_WIDTHS * width, PLACE_SHARE)
        places = np.concatenate([-places, places, -beside, beside])
        height = np.exp(-(((torques * PLACE_SHARE - places[:, None]) / width) ** 2))
        own = height**2 @ count
        new = own - ((height @ of_basis) ** 2).sum(axis=1)
        distinct = ((height > ON_BUMP).sum(axis=1) >= FEWEST_TORQUES) & (
            new > LEAST_NEW_SHARE * own
        )
        gain = np.where(distinct, (height @ of_left) ** 2 / np.where(distinct, new, 1.0), 0.0)
        if gain.max() > best:
            best = float(gain.max())
            best_bump = float(places[gain.argmax()]), width, best
    return best_bump
