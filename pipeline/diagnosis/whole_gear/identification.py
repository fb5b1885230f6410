"""Which input of the whole gear's model explains the difference between a sweep and the gear's curve.

Each input alone is moved from its nominal value until the curve fits the middle of the measured loop best,
by chi square. One that fits is named, with those that fit as well as its rivals, and a torque that would tell
the first two apart. Where none fits, two together are tried (`pairs`); where no two do, nothing is named.

| step | file |
|---|---|
| the middle of the measured loop | `central_curve.py` |
| inputs, and how each changes the model | `inputs.py` |
| each input alone | `fitted_input.py` |
| two together | `pairs.py` |
| outcome, error on other cycles, the torque that tells two apart | here, limits in `../decision.py` |
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import inf
from typing import Literal

import numpy as np
from scipy.special import chdtrc

from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.geometry.design import Design
from flexspline.geometry.rated import rated_torque
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.bend import NUMERICAL_SHARE
from flexspline.pipeline.diagnosis.decision import MISFIT_P_VALUE, RIVAL_CHI_SQUARE
from flexspline.pipeline.diagnosis.rated_limit import within_rated
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.sweep.analysis import SweepAnalysis
from flexspline.pipeline.diagnosis.whole_gear.central_curve import CentralCurve, central_curve
from flexspline.pipeline.diagnosis.whole_gear.fitted_input import (
    FittedInput,
    angles_as_recorded,
    fitted,
)
from flexspline.pipeline.diagnosis.whole_gear.inputs import GearInput, inputs_of
from flexspline.pipeline.diagnosis.whole_gear.pairs import FittedPair, fitted_pairs
from flexspline.pipeline.gear.gear_chain import Chain

RIVAL_TORQUE_SHARES = (0.25, 0.5, 1.0, 1.5, 2.0)
"""Torques at which rivals are compared, of the largest measured."""
MEASURABLE_DEVIATIONS = 3.0
"""Standard deviations by which two rivals must differ at a torque to be distinguished there."""
InputsVerdict = Literal["consistent", "named", "pair", "unknown"]


@dataclass(frozen=True)
class Apart:
    """A torque [N·m] at which the two best inputs differ by so much [arcsec]."""

    torque_Nm: float
    difference_arcsec: float


@dataclass(frozen=True)
class GearIdentification:
    """What the middle of the loop says of the gear's inputs.

    Attributes
    ----------
    outcome : "consistent": the nominal curve fits; "named": an input alone explains the rest; "pair": two
        together do; "unknown": no two do.
    remainder_arcsec : root mean square of measured less nominal curve.
    chi_square, places : of the nominal curve, and how many torques it is of.
    fitted : every input, the best first. rivals : keys of those that fit as well as the best, if that is
        named.
    pairs : those of two that fit, the best first, where no input alone does.
    left_arcsec : root mean square with the best input or pair, on cycles that were not fitted, and
        `before_arcsec` without it on the same; None of one cycle.
    apart : None where nothing is named, or no torque up to twice the largest, and to the rated one, tells the
        first two apart.
    """

    outcome: InputsVerdict
    remainder_arcsec: float
    chi_square: float
    places: int
    fitted: tuple[FittedInput, ...]
    rivals: tuple[str, ...] = ()
    pairs: tuple[FittedPair, ...] = ()
    before_arcsec: float | None = None
    left_arcsec: float | None = None
    apart: Apart | None = None


def gear_inputs(design: Design, chain: Chain, analysis: SweepAnalysis) -> GearIdentification | None:
    """Of a sweep held against the gear; None of several units, or where a sign of torque is missing.

    Raises
    ------
    EquilibriumError : no equilibrium at a measured torque with the nominal values.
    """
    if len(analysis.explained.prepared.sweep.units) > 1:
        return None
    curve = central_curve(analysis)
    if curve is None:
        return None
    inputs = {one.key: one for one in inputs_of(design, chain)}
    # this solve takes longest; the others start from it
    start = chain.model.at_torque(curve.smallest_Nm)
    nominal = angles_as_recorded(chain, curve, start)
    curve = _with_numerical(curve, nominal)
    off = curve.angle_arcsec - nominal
    base = float(((off / curve.std_arcsec) ** 2).sum())
    each = (fitted(one, chain, curve, nominal, start) for one in inputs.values())
    # an input that moves nothing on this gear has no value
    by_misfit = sorted((f for f in each if f.std < inf), key=lambda one: one.chi_square)
    plain = GearIdentification("consistent", rms(off), base, len(off), tuple(by_misfit))
    if _fits(base, len(off)):
        return plain
    if not by_misfit:
        return replace(plain, outcome="unknown")
    best = by_misfit[0]
    if not _fits(best.chi_square, len(off) - 1):
        return _of_pairs(plain, tuple(inputs.values()), chain, curve, analysis, start)
    rivals = [
        f
        for f in by_misfit[1:]
        if f.chi_square < best.chi_square + RIVAL_CHI_SQUARE and f.value != f.nominal
    ]
    one = inputs[best.key]

    def alone(learnt: CentralCurve) -> Chain:
        drawn = angles_as_recorded(chain, learnt, start)
        return one.changed(chain, fitted(one, chain, learnt, drawn, start).value)

    before, left = _on_other_cycles(alone, chain, analysis, start)
    return replace(
        plain,
        outcome="named",
        rivals=tuple(f.key for f in rivals),
        before_arcsec=before,
        left_arcsec=left,
        apart=_apart(inputs, chain, curve, (best, rivals[0]), rated_torque(design)[0])
        if rivals
        else None,
    )


def _of_pairs(
    plain: GearIdentification,
    inputs: tuple[GearInput, ...],
    chain: Chain,
    curve: CentralCurve,
    analysis: SweepAnalysis,
    start: Equilibrium,
) -> GearIdentification:
    """The pair that fits, and those that fit as well; "unknown" where none does."""

    def together(learnt: CentralCurve, of: tuple[GearInput, ...]) -> list[FittedPair]:
        return fitted_pairs(
            of,
            chain,
            lambda each: angles_as_recorded(each, learnt, start),
            learnt.angle_arcsec,
            learnt.std_arcsec,
        )

    fit = [p for p in together(curve, inputs) if _fits(p.chi_square, plain.places - 2)]
    if not fit:
        return replace(plain, outcome="unknown")
    best = fit[0]
    pairs = tuple(p for p in fit if p.chi_square < best.chi_square + RIVAL_CHI_SQUARE)
    before, left = _on_other_cycles(
        lambda learnt: together(learnt, best.inputs)[0].changed(chain), chain, analysis, start
    )
    return replace(plain, outcome="pair", pairs=pairs, before_arcsec=before, left_arcsec=left)


def _fits(chi_square: float, degrees_of_freedom: int) -> bool:
    return bool(chdtrc(degrees_of_freedom, chi_square) >= MISFIT_P_VALUE)


def _with_numerical(curve: CentralCurve, nominal: np.ndarray) -> CentralCurve:
    wind_up = nominal - nominal[0]
    return replace(curve, std_arcsec=np.hypot(curve.std_arcsec, NUMERICAL_SHARE * wind_up))


def _on_other_cycles(
    learn: Callable[[CentralCurve], Chain],
    chain: Chain,
    analysis: SweepAnalysis,
    start: Equilibrium,
) -> tuple[float | None, float | None]:
    """Root mean square on every second cycle, of the gear as drawn and as learnt on the others."""
    cycles = np.unique(analysis.explained.prepared.rig.history.cycle)
    if len(cycles) < 2:
        return None, None
    learnt, other = (central_curve(analysis, cycles[odd::2].tolist()) for odd in (0, 1))
    if learnt is None or other is None:
        return None, None
    better = learn(_with_numerical(learnt, angles_as_recorded(chain, learnt, start)))
    before, after = (
        other.angle_arcsec - angles_as_recorded(each, other, start) for each in (chain, better)
    )
    return rms(before), rms(after)


def _apart(
    inputs: Mapping[str, GearInput],
    chain: Chain,
    curve: CentralCurve,
    both: tuple[FittedInput, FittedInput],
    rated_Nm: float,
) -> Apart | None:
    """Where the two differ most, within rated torque, if a place as sure as those measured shows it."""
    wished = curve.largest_Nm * np.array(RIVAL_TORQUE_SHARES)
    torques = np.array(within_rated(wished.tolist(), curve.largest_Nm, rated_Nm))
    first, second = (
        inputs[each.key].changed(chain, each.value).angles(torques.tolist()) * ARCSEC_PER_RAD
        for each in both
    )
    most = int(np.abs(first - second).argmax())
    difference = abs(float(first[most] - second[most]))
    if difference < MEASURABLE_DEVIATIONS * float(curve.std_arcsec.max()):
        return None
    return Apart(float(torques[most]), difference)
