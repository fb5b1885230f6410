"""How much a record's curve bends: as simulated, by the factor of its slope, or less than either.

A gear that is stiffer or softer than simulated all over bends less or more by the same factor; a spring in
series leaves the bend as it is. Which of the two a record shows is decided before the race, in which a bend
that is scaled wrongly would be a hardening or a softening. A soft wind-up bends a curve more, and is a cause
of the race. A curve that bends much less than both has lost a part of the bend, which is no cause's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.measurement.crossing_band import BAND_SHARE
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.sweep.calibrated_residual import ALLOWED_SIGMAS

LOOP_POWERS = (0, 1, 2)
"""Powers of torque by which a loop's width varies: equal everywhere, wider at large torque, and closed at the
largest."""
WIND_UPS = (0.06, 0.12, 0.25, 0.5)
"""Of the largest torque, scales of a soft wind-up, tanh: without them it would pass for more bend."""
FEWEST_BEND_ROWS = 32
"""Fewest rows: twice the unknowns of one unit."""
LOST_RATIO, FEWEST_LOST_ROWS = 2.0, 40
"""Squares left by the better of both bends over those left by a bend of its own size, from which a part of it
is lost; of so many rows the odds are then a million to 1."""


@dataclass(frozen=True)
class _Record:
    """What a record's angle (n,) is fitted with.

    `beside` (n, k): columns of all that is neither slope nor bend; `wind_ups` (n, w): those of a soft
    wind-up, none of them negative.
    """

    angle: np.ndarray
    beside: np.ndarray
    wind_ups: np.ndarray

    def fitted(self, curves: Sequence[np.ndarray], taken: np.ndarray | float) -> _Fitted:
        """By these curves (n,), none of them turned over, once `taken` is off the angle."""
        from scipy.optimize import lsq_linear

        columns = np.column_stack([*curves, self.wind_ups, self.beside])
        size = np.abs(columns).max(axis=0)
        size[size == 0] = 1.0
        least = np.full(columns.shape[1], -np.inf)
        least[: len(curves) + self.wind_ups.shape[1]] = 0.0
        solution = lsq_linear(columns / size, self.angle - taken, (least, np.inf), method="bvls")
        return _Fitted((solution.x / size)[: len(curves)], 2 * float(solution.cost))


@dataclass(frozen=True)
class _Fitted:
    """By what each curve is scaled, and the sum of squares left."""

    scales: np.ndarray
    left: float


def with_scaled_bend(prediction: Prediction, sweep: Sweep) -> Prediction:
    """The prediction with the bend that the record's curve has; as it was where a spring explains it better.

    Slope on both sides of the gap, zero and drift of each unit, a loop and a soft wind-up are fitted by least
    squares: once beside the simulated bend, once with the bend scaled by the slope. Both have as many
    unknowns. A slope within the stated uncertainty is no finding, and moves no bend. Where a bend of a size
    of its own, smaller than both, leaves far less, it is the record's, and the rest is lost.
    """
    if prediction.bend is None:
        return prediction
    history = sweep.history
    largest = history.largest_Nm
    rows = np.abs(history.torque_Nm) > BAND_SHARE * largest
    if int(rows.sum()) < FEWEST_BEND_ROWS:
        return prediction
    bend = prediction.bend.at(history.torque_Nm)[rows]
    line = prediction.compliance * history.torque_Nm[rows]
    share = history.torque_Nm[rows, None] / largest
    twist = prediction.compliance * largest
    wind_ups = twist * np.sign(share) * np.tanh(np.abs(share) / np.array(WIND_UPS))
    record = _Record(sweep.angle_arcsec[rows], _beside(sweep, largest)[rows], wind_ups)
    spring = record.fitted([line], bend)
    scaled = record.fitted([line + bend], 0.0)
    scale, own = float(scaled.scales[0]), record.fitted([line, bend], 0.0)
    nearer = scale if scaled.left < spring.left else 1.0
    size = float(own.scales[1])
    best = min(scaled.left, spring.left)
    if size < nearer and best > LOST_RATIO * own.left and int(rows.sum()) >= FEWEST_LOST_ROWS:
        lost = prediction.bend.scaled(nearer - size)
        return replace(prediction, measured_bend=prediction.bend.scaled(size), lost_bend=lost)
    allowed = ALLOWED_SIGMAS * prediction.compliance_std / prediction.compliance
    if nearer == 1.0 or abs(scale - 1) <= allowed:
        return prediction
    return replace(prediction, measured_bend=prediction.bend.scaled(scale))


def _beside(sweep: Sweep, largest: float) -> np.ndarray:
    """(n, k) columns of all that is neither slope nor bend."""
    history = sweep.history
    share, direction = history.torque_Nm / largest, direction_of_loading(history)
    columns = [history.sign, *(direction * np.abs(share) ** p for p in LOOP_POWERS)]
    for unit in history.unit_slices:
        for values in (np.ones(len(unit)), np.linspace(-1, 1, len(unit))):
            own = np.zeros(len(history))
            own[unit] = values
            columns.append(own)
    return np.column_stack(columns)
