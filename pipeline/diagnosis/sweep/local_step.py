"""Where the curve over the torque has steps, if it has any: before anything else is fitted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.local_bump import beside_bumps, less, orthonormal

PLACE_SHARE = 0.005
"""Of the largest torque, between places that are tried."""
NEAREST_SHARE, FURTHEST_SHARE = 0.12, 0.92
"""Of the largest torque, the places that are tried on either side. Nearer to zero a step is that of the gap
or of a soft wind-up; further out too few rows lie beyond it."""
WIDTH_SHARES = (0.003, 0.01, 0.025)
"""Of the largest torque, over which it rises from 27 to 73 %. Wider ones are what smooth functions can be."""
MOST_STEPS = 2
"""Of a record: a key that is loose steps once on either side."""


LEAST_ROWS = 1.0
"""Square of a step less the smooth functions, in rows: with less it is one of them."""


@dataclass(frozen=True)
class CurveStep:
    """A step of the curve, 1/(1 + exp(−(|T| − |place|)/width)) on the place's side of zero."""

    place_Nm: float
    width_Nm: float

    def of(self, torque_Nm: np.ndarray) -> np.ndarray:
        """(n,) of height 1, with the sign of the torque at its place."""
        side = np.sign(self.place_Nm)
        return np.asarray(
            side / 2 * (1 + np.tanh((side * torque_Nm - abs(self.place_Nm)) / 2 / self.width_Nm))
        )


def curve_steps(
    history: History, angle_arcsec: np.ndarray, kept: np.ndarray
) -> tuple[CurveStep, ...]:
    """The steps that explain most beside smooth functions and friction, each beside those before it.

    Parameters
    ----------
    angle_arcsec : (n,) measured less simulated angle. kept : (n,) rows that count.
    """
    rows, largest = np.flatnonzero(kept), history.largest_Nm
    x = history.torque_Nm[rows] / largest
    basis = orthonormal(beside_bumps(history, rows))
    left = angle_arcsec[rows] - basis @ (basis.T @ angle_arcsec[rows])
    places = np.arange(NEAREST_SHARE, FURTHEST_SHARE, PLACE_SHARE)
    tried = [CurveStep(p, w) for w in WIDTH_SHARES for p in (*-places, *places)]
    columns = less(basis, np.column_stack([step.of(x) for step in tried]))
    steps: list[CurveStep] = []
    for _ in range(MOST_STEPS):
        own = (columns**2).sum(axis=0)
        distinct = own > LEAST_ROWS
        gain = np.where(distinct, (left @ columns) ** 2 / np.where(distinct, own, 1.0), 0.0)
        best = int(gain.argmax())
        if not gain[best] > 0:
            break
        steps.append(CurveStep(tried[best].place_Nm * largest, tried[best].width_Nm * largest))
        now = columns[:, [best]] / np.sqrt(own[best])
        left, columns = less(now, left), less(now, columns)
    return tuple(steps)
