"""A first guess of friction ahead of the teeth, before anything is fitted.

It crosses the gap late both ways, and would pass for hardening and a negative gap.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import steadied, stops
from flexspline.pipeline.diagnosis.measurement.crossing_band import BAND_SIGMAS
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm, torque_noise_Nm
from flexspline.pipeline.diagnosis.sweep.crossing.gap_crossing import OFFSET_REACH, on_both_sides
from flexspline.pipeline.diagnosis.sweep.crossing.step_fit import (
    LEAST_STEP,
    StepFit,
    looped_functions,
    nats_over,
)
from flexspline.pipeline.diagnosis.sweep.crossing.torque_offset_guess import FIRST_NATS

LARGEST_FRICTION = 0.45
"""Largest friction that is tried, over the largest torque. With more, the teeth would carry hardly more than
the bearing."""
COARSE_PLACES, FINE_PLACES = 16, 9
"""Places tried: 2.8 % of the largest torque apart, less than the band's whole width (7 %), then between."""
BOTH_NATS = 6.0
"""Nats of friction alone over none from which a shifted reading beside it is tried. Each can hide the
other."""
OFFSETS = 33
"""Places of a shifted reading tried against it: 2.2 % of the largest torque apart, less than the band."""
ALIKE_PLACES, ALIKE_NATS = 60, 1.0
"""Frictions tried of those between which no row tells; two that are as near as this in nats fit alike."""
NEAR_OFFSET_NATS = 3.0
"""Over the best of them, odds of 20 to 1: a race with either decides what is as near as that."""


@dataclass(frozen=True)
class AheadGuess:
    """A friction torque, and the nats of the step's place over the best one without it; beside an offset."""

    friction_Nm: float
    nats: float
    offset_Nm: float = 0.0


@dataclass(frozen=True)
class _AheadSearch:
    """Frictions and shifted readings that are tried on a record.

    Attributes
    ----------
    steady_Nm : (n,) torque, `steadied`.
    frictions_Nm, carried_Nm : (COARSE_PLACES,) tried at first, and the torque (n, COARSE_PLACES) of each.
    offsets_Nm : (OFFSETS,) of the reading.
    misfit : what the angle's fit leaves where the gap is crossed so much torque [N·m] later.
    """

    history: History
    steady_Nm: np.ndarray
    frictions_Nm: np.ndarray
    carried_Nm: np.ndarray
    offsets_Nm: np.ndarray
    misfit: Callable[[np.ndarray | float], float]

    def friction(self, offset_Nm: float = 0.0) -> tuple[int, float]:
        """The best friction of the first ones beside a shifted reading, and its misfit."""
        misfits = [self.misfit(carried + offset_Nm) for carried in self.carried_Nm.T]
        return _least(misfits)

    def offset(self, carried_Nm: np.ndarray | float) -> tuple[int, float]:
        """The best shifted reading beside a friction, and its misfit."""
        misfits = [self.misfit(carried_Nm + offset) for offset in self.offsets_Nm]
        return _least(misfits)

    def both(self, friction: int, offset: int) -> tuple[int, int, float]:
        """The best of each beside the best of the other, begun with either, and their misfit."""
        beside_friction = self.offset(self.carried_Nm[:, friction])[0]
        beside_offset = self.friction(self.offsets_Nm[offset])[0]
        first, of_first = self.friction(self.offsets_Nm[beside_friction])
        second, of_second = self.offset(self.carried_Nm[:, beside_offset])
        if of_second < of_first:
            return beside_offset, second, of_second
        return first, beside_friction, of_first

    def finer(self, friction: int, misfit: float, offset_Nm: float = 0.0) -> tuple[float, float]:
        """The friction [N·m] near one of the first ones, and its misfit."""
        first = self.frictions_Nm[friction]
        fine = first + self.frictions_Nm[0] * np.linspace(-1, 1, FINE_PLACES + 2)[1:-1]
        carried = stops(self.history, self.steady_Nm, fine, np.zeros(FINE_PLACES))
        again = [self.misfit(own + offset_Nm) for own in carried.T]
        k, least = _least(again)
        return (fine[k], least) if least <= misfit else (first, misfit)


def _least(misfits: list[float]) -> tuple[int, float]:
    """Which is the least, and how much."""
    k = int(np.argmin(misfits))
    return k, misfits[k]


def first_ahead(
    history: History, angle_arcsec: np.ndarray, gap_arcsec: float, band_Nm: float
) -> AheadGuess | None:
    """The guess; None where there is none to see.

    The angle is fitted by smooth functions of torque, a stiffness of each position, friction elements, lags,
    which open the loop most where the gap is crossed, and one step of free height, crossed where the torque
    beyond a play operator changes sign; the play's width is the guess, if it is clearly better than none, and
    than a shifted torque reading; or both, if they are clearly better than either.
    """
    if not on_both_sides(history.torque_Nm):
        return None
    rows = len(history)
    step = StepFit(looped_functions(history), angle_arcsec, gap_arcsec, band_Nm)

    def misfit(later_Nm: np.ndarray | float, least: float = LEAST_STEP) -> float:
        return step.misfit(history.torque_Nm - later_Nm, least)

    steady = steadied(history, deadband_Nm(history))
    coarse = np.linspace(0, LARGEST_FRICTION, COARSE_PLACES + 1)[1:] * history.largest_Nm
    search = _AheadSearch(
        history,
        steady,
        coarse,
        stops(history, steady, coarse, np.zeros(COARSE_PLACES)),
        np.linspace(-OFFSET_REACH, OFFSET_REACH, OFFSETS) * history.largest_Nm,
        misfit,
    )
    best, least = search.friction()
    if not np.isfinite(least) or least <= 0:
        return None
    friction, least = search.finer(best, least)
    nats = nats_over(misfit(0.0, -np.inf), least, rows)
    if nats < BOTH_NATS:
        return None
    shifted, of_offset = search.offset(0.0)
    beside, place, joint = search.both(best, shifted)
    if nats_over(min(least, of_offset), joint, rows) >= FIRST_NATS:
        offset = float(search.offsets_Nm[place])
        friction, joint = search.finer(beside, joint, offset)
        nats = nats_over(min(least, of_offset), joint, rows)
        return AheadGuess(float(friction), nats, offset)
    over_offset = nats_over(of_offset, least, rows)
    if nats < FIRST_NATS or over_offset < NEAR_OFFSET_NATS:
        return None
    return AheadGuess(float(friction), min(nats, over_offset))


def frictions_alike(
    history: History,
    angle_arcsec: np.ndarray,
    gap_arcsec: float,
    guess: AheadGuess,
    largest_Nm: float,
) -> tuple[float, float]:
    """Ends [N·m] of the frictions up to a largest one between which the gap's step fits alike.

    The rows on either side of the crossing set them; the guess may lie anywhere between, and beside them, as
    it does not look at rows next to the step. Here those are left out only that the torque's noise hides.
    """
    rows = len(history)
    tried = np.linspace(0, largest_Nm, ALIKE_PLACES + 1)[1:]
    carried = stops(history, steadied(history, deadband_Nm(history)), tried, np.zeros(ALIKE_PLACES))
    noise_Nm = BAND_SIGMAS * torque_noise_Nm(history)
    beyond = (history.torque_Nm - own - guess.offset_Nm for own in carried.T)
    step = StepFit(looped_functions(history), angle_arcsec, gap_arcsec, noise_Nm)
    misfits = [step.misfit(b) for b in beyond]
    best, least = _least(misfits)
    if not np.isfinite(least) or least <= 0:
        return guess.friction_Nm, guess.friction_Nm
    other = np.array([nats_over(m, least, rows) > ALIKE_NATS for m in misfits])
    low = int(np.flatnonzero(np.r_[True, other[:best]])[-1])
    high = best + int(np.flatnonzero(np.r_[other[best:], True])[0])
    return float(tried[low]), float(tried[high - 1])
