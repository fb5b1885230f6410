"""Two inputs of the whole gear's model together, where none alone explains a sweep.

All pairs are compared by the curve's slopes at the nominal values; the most promising are then followed with
the model itself, by Gauss-Newton steps within the inputs' ends and Broyden's update of the slopes (Nocedal
and Wright, Numerical Optimization, chapter 11).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.optimize import lsq_linear

from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.diagnosis.whole_gear.inputs import GearInput
from flexspline.pipeline.gear.gear_chain import Chain

PAIRS_FOLLOWED = 3
"""Pairs that are fitted with the model. Slopes at the nominal values put them in order roughly. Judgement."""
PAIR_STEPS = 6
"""Of Gauss-Newton; the sixth step of made-up records is below a hundredth of a deviation."""
PAIR_SETTLED_SHARE = 0.02
"""Share of a first step. A smaller change of both inputs ends the search. Judgement."""
LEAST_ROOM = 1e-9
"""In first steps: an input whose end is reached has no room, and `lsq_linear` wants ends that differ."""
ChainAngles = Callable[[Chain], np.ndarray]


@dataclass(frozen=True)
class FittedPair:
    """Where two inputs fit best together, one standard deviation each, and the chi square left."""

    inputs: tuple[GearInput, GearInput]
    values: tuple[float, float]
    stds: tuple[float, float]
    chi_square: float

    @property
    def keys(self) -> tuple[str, str]:
        """Of both."""
        return self.inputs[0].key, self.inputs[1].key

    def changed(self, chain: Chain) -> Chain:
        """The gear with both values."""
        return _with(chain, self.inputs, np.array(self.values))


def fitted_pairs(
    inputs: Sequence[GearInput],
    chain: Chain,
    curve: ChainAngles,
    wanted: np.ndarray,
    std: np.ndarray,
) -> list[FittedPair]:
    """The most promising pairs, the best first.

    `curve`: a gear's angles (m,) [arcsec]; `wanted`, `std` (m,): those measured, and their deviations.
    """
    nominal = curve(chain)
    slopes: dict[str, np.ndarray] = {}
    for one in inputs:
        try:
            moved = curve(one.changed(chain, one.nominal + one.first))
        except ComputationError:  # no gear with that value
            continue
        slopes[one.key] = (moved - nominal) / one.first
    off = wanted - nominal
    possible = [
        (both, np.column_stack([slopes[one.key] for one in both]))
        for both in combinations([one for one in inputs if one.key in slopes], 2)
    ]
    possible.sort(key=lambda each: _bounded(each[0], _nominal(each[0]), each[1], off, std)[1])
    pairs = [
        _followed(both, chain, curve, (nominal, slope), (wanted, std))
        for both, slope in possible[:PAIRS_FOLLOWED]
    ]
    return sorted(pairs, key=lambda each: each.chi_square)


def _followed(
    both: tuple[GearInput, GearInput],
    chain: Chain,
    curve: ChainAngles,
    start: tuple[np.ndarray, np.ndarray],
    measured: tuple[np.ndarray, np.ndarray],
) -> FittedPair:
    """`start`: the nominal angles (m,) and their slopes (m, 2); `measured`: angles and deviations."""
    (angles, slope), (wanted, std) = start, measured
    at = _nominal(both)
    best = at, float((((wanted - angles) / std) ** 2).sum())
    for _ in range(PAIR_STEPS):
        step, _ = _bounded(both, at, slope, wanted - angles, std)
        if (np.abs(step) < PAIR_SETTLED_SHARE * np.array([one.first for one in both])).all():
            break
        try:
            other = curve(_with(chain, both, at + step))
        except ComputationError:  # no gear with those values
            break
        slope = slope + np.outer(other - angles - slope @ step, step) / (step @ step)
        at, angles = at + step, other
        chi_square = float((((wanted - angles) / std) ** 2).sum())
        if chi_square < best[1]:
            best = at, chi_square
    weighed = slope / std[:, None]
    stds = np.sqrt(np.diag(np.linalg.pinv(weighed.T @ weighed)))
    values, chi_square = best
    return FittedPair(both, tuple(values.tolist()), tuple(stds.tolist()), chi_square)


def _bounded(
    both: tuple[GearInput, GearInput],
    at: np.ndarray,
    slope: np.ndarray,
    off: np.ndarray,
    std: np.ndarray,
) -> tuple[np.ndarray, float]:
    """The step (2,) within the inputs' ends that straight lines ask for, and the chi square they leave."""
    unit = np.array([one.first for one in both])
    ends = np.array([(one.low, one.high) for one in both])
    room = (ends - at[:, None]) / unit[:, None]
    room[:, 1] = np.maximum(room[:, 1], room[:, 0] + LEAST_ROOM)
    solution = lsq_linear(slope * unit / std[:, None], off / std, bounds=(room[:, 0], room[:, 1]))
    return solution.x * unit, 2 * float(solution.cost)


def _nominal(both: tuple[GearInput, GearInput]) -> np.ndarray:
    return np.array([one.nominal for one in both])


def _with(chain: Chain, both: tuple[GearInput, GearInput], values: np.ndarray) -> Chain:
    for one, value in zip(both, values.tolist(), strict=True):
        chain = one.changed(chain, value)
    return chain
