"""Where one input of the whole gear's model fits the middle of a measured loop best."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.whole_gear.central_curve import CentralCurve
from flexspline.pipeline.diagnosis.whole_gear.inputs import GearInput
from flexspline.pipeline.gear.gear_chain import Chain

SECANT_STEPS = 4
"""Most steps of the secant method. Curves are nearly linear in an input, and the last steps are below 1 % of
the first."""
SETTLED_SHARE = 0.01
"""Share of an input's first step. A smaller change ends the search: the last of the four steps would be as
small."""
KNOTS = 16
"""Torques at which a curve is computed: denser where it is small and teeth come into mesh."""


@dataclass(frozen=True)
class FittedInput:
    """Where an input fits best, one standard deviation, and the chi square left with it."""

    key: str
    unit: str
    nominal: float
    value: float
    std: float
    chi_square: float
    at_limit: bool


def fitted(
    one: GearInput, chain: Chain, curve: CentralCurve, nominal: np.ndarray, start: Equilibrium
) -> FittedInput:
    """Its value of least chi square, by secants from the nominal curve (m,) [arcsec].

    `start`: as of `angles_as_recorded`.
    """
    value, angles, trial = one.nominal, nominal, one.nominal + one.first
    best = (value, _chi_square(curve, angles))
    slope = np.zeros_like(nominal)
    states: list[Equilibrium] = []
    for _ in range(SECANT_STEPS):
        gear = one.changed(chain, trial)
        try:
            if gear.model is not chain.model or not states:  # a spring in series turns no contact
                states = _states(gear, curve, start)
            other = _as_recorded(gear, curve, states)
        except ComputationError:  # no gear with that value
            break
        slope = (other - angles) / (trial - value)
        value, angles = trial, other
        best = min(best, (value, _chi_square(curve, angles)), key=lambda each: each[1])
        weight = slope / curve.std_arcsec**2
        if not weight @ slope > 0:  # it moves nothing
            break
        step = float(weight @ (curve.angle_arcsec - angles)) / float(weight @ slope)
        trial = float(np.clip(value + step, one.low, one.high))
        if abs(trial - value) < SETTLED_SHARE * one.first:
            break
    information = float(((slope / curve.std_arcsec) ** 2).sum())
    std = information**-0.5 if information > 0 else float("inf")
    at_limit = best[0] in (one.low, one.high)
    return FittedInput(one.key, one.unit, one.nominal, best[0], std, best[1], at_limit)


def angles_as_recorded(chain: Chain, curve: CentralCurve, start: Equilibrium) -> np.ndarray:
    """(m,) the gear's angle as the record has it [arcsec]: its mean over the torques of each place.

    `start`: an equilibrium at about the smallest torque, of a gear like it.
    """
    return _as_recorded(chain, curve, _states(chain, curve, start))


def _knots(curve: CentralCurve) -> np.ndarray:
    return np.geomspace(curve.smallest_Nm, curve.largest_Nm, KNOTS)


def _states(chain: Chain, curve: CentralCurve, start: Equilibrium) -> list[Equilibrium]:
    return chain.along(_knots(curve).tolist(), start)


def _as_recorded(chain: Chain, curve: CentralCurve, states: list[Equilibrium]) -> np.ndarray:
    angle = PchipInterpolator(_knots(curve), [chain.angle(at) for at in states])
    read = [np.maximum(sizes, curve.smallest_Nm) for sizes in curve.torques_Nm]
    return ARCSEC_PER_RAD * np.array([float(angle(sizes).mean()) for sizes in read])


def _chi_square(curve: CentralCurve, angles: np.ndarray) -> float:
    return float((((curve.angle_arcsec - angles) / curve.std_arcsec) ** 2).sum())
