"""A first guess of friction ahead of the teeth, before anything is fitted.

It crosses the gap late both ways, and would pass for hardening and a negative gap.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import steadied, stops
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm
from flexspline.pipeline.diagnosis.sweep.first_offset import FIRST_NATS
from flexspline.pipeline.diagnosis.sweep.step_place import (
    LEAST_STEP,
    looped_functions,
    nats_over,
    step_misfit,
)
from flexspline.pipeline.diagnosis.sweep.torque_offset import OFFSET_REACH, on_both_sides

LARGEST_FRICTION = 0.45
"""Friction tried, of the largest torque: with more the teeth carry hardly more than the bearing."""
COARSE_PLACES, FINE_PLACES = 16, 9
"""Places tried: 2.8 % of the largest torque apart, less than the band's whole width (7 %), then between."""
BOTH_NATS = 6.0
"""Of the friction alone over none, from which a shifted reading beside it is tried: each hides the other."""
OFFSETS = 33
"""Places of a shifted reading tried against it: 2.2 % of the largest torque apart, less than the band."""
NEAR_OFFSET_NATS = 3.0
"""Over the best of them, odds of 20 to 1: a race with either decides what is as near as that."""


@dataclass(frozen=True)
class AheadGuess:
    """A friction torque, and the nats of the step's place over the best one without it; beside an offset."""

    friction_Nm: float
    nats: float
    offset_Nm: float = 0.0


def first_ahead(
    history: History, angle_arcsec: np.ndarray, gap_arcsec: float, band_Nm: float
) -> AheadGuess | None:
    """The guess; None where there is none to see.

    The angle is fitted by smooth functions of torque, a stiffness of each position, friction elements, lags,
    which open the loop most where the gap is crossed, and one step of free height, crossed where the torque
    beyond a play operator changes sign; the play's width is the guess, if it is clearly better than none, and
    than a shifted torque reading; or both, if they are clearly better than either.
    """
    largest = history.largest_Nm
    if not on_both_sides(history.torque_Nm):
        return None
    torque = steadied(history, deadband_Nm(history))
    coarse = np.linspace(0, LARGEST_FRICTION, COARSE_PLACES + 1)[1:] * largest
    carried = stops(history, torque, coarse, np.zeros(COARSE_PLACES))
    smooth = looped_functions(history)

    def misfit(carried_Nm: np.ndarray | float, least: float = LEAST_STEP) -> float:
        beyond = history.torque_Nm - carried_Nm
        return step_misfit(beyond, smooth, angle_arcsec, gap_arcsec, band_Nm, least)

    places = np.linspace(-OFFSET_REACH, OFFSET_REACH, OFFSETS) * largest
    table = [misfit(carried[:, k]) for k in range(COARSE_PLACES)]
    best = int(np.argmin(table))
    if not np.isfinite(table[best]) or table[best] <= 0:
        return None
    rows = len(history)

    def finer(best: int, coarsest: float, offset: float) -> tuple[float, float]:
        """The friction near one of the coarse places, and its misfit."""
        fine = coarse[best] + coarse[0] * np.linspace(-1, 1, FINE_PLACES + 2)[1:-1]
        near = stops(history, torque, fine, np.zeros(FINE_PLACES))
        again = [misfit(near[:, k] + offset) for k in range(FINE_PLACES)]
        k = int(np.argmin(again))
        return (fine[k], again[k]) if again[k] <= coarsest else (coarse[best], coarsest)

    friction, least = finer(best, table[best], 0.0)
    nats = nats_over(misfit(0.0, -np.inf), least, rows)
    if nats < BOTH_NATS:
        return None

    def placed(carried_Nm: np.ndarray | float) -> tuple[int, float]:
        """The best place of a shifted reading, and its misfit."""
        found = [misfit(carried_Nm + p) for p in places]
        return int(np.argmin(found)), min(found)

    def rubbed(place: int) -> tuple[int, float]:
        """The best friction beside a shifted reading, and its misfit."""
        found = [misfit(carried[:, k] + places[place]) for k in range(COARSE_PLACES)]
        return int(np.argmin(found)), min(found)

    shifted, of_offset = placed(0.0)
    # both at once: the best of the one for the best of the other, begun with either
    beside_friction = placed(carried[:, best])[0]
    beside_offset = rubbed(shifted)[0]
    pairs = [
        (*rubbed(beside_friction), beside_friction),
        (beside_offset, *placed(carried[:, beside_offset])[::-1]),
    ]
    k, joint, place = min(pairs, key=lambda pair: pair[1])
    if nats_over(min(least, of_offset), joint, rows) >= FIRST_NATS:
        offset = float(places[place])
        friction, joint = finer(k, joint, offset)
        nats = nats_over(min(least, of_offset), joint, rows)
        return AheadGuess(float(friction), nats, offset)
    over_offset = nats_over(of_offset, least, rows)
    if nats < FIRST_NATS or over_offset < NEAR_OFFSET_NATS:
        return None
    return AheadGuess(float(friction), min(nats, over_offset))
