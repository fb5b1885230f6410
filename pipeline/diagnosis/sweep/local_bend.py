"""Where the curve over the torque bends, on both sides of zero or on one: before anything else is fitted.

The terms with steps of their own stand beside others: a bend between two of those was told as ripples, bumps
and a compliance that is not there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import exp, log
from typing import Literal

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.local_bump import friction_loops, orthonormal

Law = Literal["power", "gradual"]
"""((|T| − place)/(largest − place))^power beyond the place; a slope that grows as 1/(1 + exp(−(|T| − place)/
width)). Of joints that open at a load, at once or by a half within some tenths of the torque, of contacts
whose zone shrinks, and of powers, the better of the two leaves 0 to 4 % of the bend."""
BIN_SHARE = 0.005
"""Of the largest torque: rows within one count together."""
PLACES = tuple(np.arange(19) / 20)
"""Shares of the largest torque from which a bend is tried first; beyond 0.9 too few rows lie."""
POWERS = (1.0, 1.3, 1.7, 2.2, 3.0, 4.0)
"""Of a bend from a place on, tried first."""
WIDTHS = (0.02, 0.05, 0.1, 0.2, 0.4)
"""Of the largest torque, over which a gradual bend begins, tried first."""
LIMITS: dict[Law, tuple[tuple[float, float], tuple[float, float]]] = {
    "power": ((0.0, 0.92), (1.0, 4.5)),
    "gradual": ((0.05, 1.0), (log(0.01), log(0.5))),
}
"""Of place and power, or of place and log of the width, as shares of the largest torque. A gradual bend
beyond them is a power, or a straight line."""
MOST_AT_HALF = 0.41
"""Of the twist at the largest torque, at half of it, of a bend of one side: with more it is two stiffnesses
(`../causes/direction_asymmetry.py`)."""
STRAIGHT_AT_HALF = 0.48
"""The same of a bend on both sides: with more it is a straight line. Judgement."""
LEAST_NEW = 1e-4
"""Of a bend's own square: one of which less is new beside the smooth functions is one of them."""
DOUBTED = 4.0
"""Of the mean square that is left in a row, by which a bend of other numbers fits worse: two deviations."""
FINER = 15
"""Places and shapes tried from one of the first to its neighbours: places then lie 0.007 of the largest
torque apart, which leaves 0.1 % of a bend. Judgement."""


@dataclass(frozen=True)
class CurveBend:
    """A bend of the curve: twist that grows faster than torque, of height 1 at the largest torque.

    `side` : 1 or −1, where it is on one side of zero alone; 0: on both. `shape` : power, or width [N·m].
    """

    law: Law
    place_Nm: float
    shape: float
    largest_Nm: float
    side: int = 0

    def of(self, torque_Nm: np.ndarray) -> np.ndarray:
        """(n,) with the torque's sign."""
        shape = self.shape if self.law == "power" else log(self.shape / self.largest_Nm)
        x, place = np.abs(torque_Nm) / self.largest_Nm, self.place_Nm / self.largest_Nm
        height = _height(self.law, x, np.array([place]), np.array([shape]))[0]
        sign = np.sign(torque_Nm)
        return np.asarray(
            height * (sign if not self.side else np.where(sign == self.side, sign, 0))
        )


def curve_bends(
    history: History, angle_arcsec: np.ndarray, kept: np.ndarray
) -> tuple[tuple[CurveBend, ...], ...]:
    """Bends of both sides, of the positive, of the negative one: of each law the best, with its neighbours.

    Parameters
    ----------
    angle_arcsec : (n,) measured less simulated angle. kept : (n,) rows that count.

    A bend of one side is half an odd and half an even function. The odd half is also what a soft wind-up, a
    compliance or a bend of the other side can be: it is found by its even half.
    """
    rows, largest = np.flatnonzero(kept), history.largest_Nm
    x = history.torque_Nm[rows] / largest
    if not len(rows) or not (x.min() < 0 < x.max()):
        return ()
    both, even = _beside(history, rows)
    of_both: list[CurveBend] = []
    one_side: list[CurveBend] = []
    for odd, basis in ((True, even), (False, both), (False, np.column_stack([both, np.abs(x)]))):
        binned = _Binned.of(x, angle_arcsec[rows], orthonormal(basis), odd)
        for law in LIMITS:
            bends = tuple(
                CurveBend(law, a * largest, s if law == "power" else exp(s) * largest, largest)
                for a, s in _best(law, binned)
            )
            (of_both if odd else one_side).extend(bends)
    sides = (tuple(replace(b, side=side) for b in one_side) for side in (1, -1))
    return (tuple(of_both), *sides)


def _beside(history: History, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, k) zeros, compliance, gap, friction, and odd functions of torque; the same with even ones."""
    x = history.torque_Nm / history.largest_Nm
    zeros = history.unit[:, None] == np.unique(history.unit[rows])
    direction, loops = direction_of_loading(history), friction_loops(history)
    plain = np.column_stack([zeros, x, np.sign(x), direction, loops])
    odd, even = np.column_stack([x * np.abs(x), x**3]), np.column_stack([np.abs(x), x**2, x**4])
    return np.hstack([plain, odd])[rows], np.hstack([plain, even])[rows]


@dataclass(frozen=True)
class _Binned:
    """Rows of one torque together: |torque| `x` (b,) as share of the largest, sign, sums of what the smooth
    functions leave and of their basis (b, k); `left` : mean square that they leave in a row."""

    x: np.ndarray
    sign: np.ndarray
    count: np.ndarray
    rest: np.ndarray
    basis: np.ndarray
    odd: bool
    square: float

    @classmethod
    def of(cls, x: np.ndarray, angle: np.ndarray, basis: np.ndarray, odd: bool) -> _Binned:
        rest = angle - basis @ (basis.T @ angle)
        _, at = np.unique(np.round(x / BIN_SHARE).astype(int), return_inverse=True)
        count = np.bincount(at).astype(float)
        mean = np.bincount(at, x) / count
        sums = np.column_stack([np.bincount(at, column) for column in basis.T])
        return cls(
            np.abs(mean), np.sign(mean), count, np.bincount(at, rest), sums, odd, float(rest @ rest)
        )

    def gains(self, law: Law, place: np.ndarray, shape: np.ndarray) -> np.ndarray:
        """(m,) what bends take off the sum of squares; 0 of straight lines, and beyond limits."""
        height = _height(law, np.append(self.x, 0.5), place, shape)
        column, half = height[:, :-1], height[:, -1]
        if self.odd:
            column = column * self.sign
        (near, far), (least, most) = LIMITS[law]
        fair = (near <= place) & (place <= far) & (least <= shape) & (shape <= most)
        fair &= half <= (STRAIGHT_AT_HALF if self.odd else MOST_AT_HALF)
        own = column**2 @ self.count
        new = own - ((column @ self.basis) ** 2).sum(axis=1)
        distinct = fair & (new > LEAST_NEW * own)
        return np.where(distinct, (column @ self.rest) ** 2 / np.where(distinct, new, 1.0), 0.0)


def _height(law: Law, x: np.ndarray, place: np.ndarray, shape: np.ndarray) -> np.ndarray:
    """(m, b) over |torque| (b,) as share of the largest, of bends (m,): 0 at 0 and 1 at the largest."""
    place, shape = place[:, None], shape[:, None]
    if law == "power":
        return np.asarray((np.maximum(x - place, 0.0) / (1 - place)) ** shape)
    width = np.exp(shape)
    begun = 1 / (1 + np.exp(place / width))

    def raw(at: np.ndarray) -> np.ndarray:
        grown = np.logaddexp(0.0, (at - place) / width) - np.logaddexp(0.0, -place / width)
        return np.asarray(width * grown - begun * at)

    return raw(x) / raw(np.ones(1))


def _best(law: Law, binned: _Binned) -> list[tuple[float, float]]:
    """Place and shape of the bend that explains most, and beside it those that fit it as doubtfully."""
    (_, _), (least, most_shape) = LIMITS[law]
    shapes = np.array(POWERS if law == "power" else np.log(WIDTHS))
    places, around = np.array(PLACES), np.linspace(-1, 1, FINER)
    place, shape = (grid.ravel() for grid in np.meshgrid(places, shapes))
    at = int(binned.gains(law, place, shape).argmax())
    reach = float(np.diff(shapes).max())
    place, shape = (
        grid.ravel()
        for grid in np.meshgrid(
            place[at] + (places[1] - places[0]) * around,
            np.clip(shape[at] + reach * around, least, most_shape),
        )
    )
    gain = binned.gains(law, place, shape)
    at = int(gain.argmax())
    if not gain[at] > 0:
        return []
    doubt = DOUBTED * max(binned.square - gain[at], 0.0) / float(binned.count.sum())
    alike = np.flatnonzero(gain >= gain[at] - doubt)
    chosen = (alike[place[alike].argmin()], at, alike[place[alike].argmax()])
    return [(float(place[i]), float(shape[i])) for i in dict.fromkeys(map(int, chosen))]
