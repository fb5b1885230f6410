"""Uncertain inputs of a tolerance study and their samples.

Saltelli's scheme (Comput. Phys. Commun. 181, 2010, 259-270): two Sobol-sequence samples A and B of N points,
and for each input a copy of A with that input from B, N(k + 2) designs in all.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from flexspline.geometry.errors import DesignError
from flexspline.geometry.keys import value_at, with_values
from flexspline.pipeline.study.evaluate import Task
from flexspline.pipeline.study.holes import HolesEffect
from flexspline.pipeline.study.plan import Listed, linked
from flexspline.pipeline.study.source import PlannedDesigns, solves_of
from flexspline.pipeline.study.study import Study, StudyError

if TYPE_CHECKING:
    from optuna.distributions import BaseDistribution

MODULUS = "material.flexspline.youngs_modulus_GPa"
SHAFT_MODULUS = "material.shaft.youngs_modulus_GPa"
CLEARANCE, PLAY = "gear.flank_clearance_um", "bearing.radial_clearance_um"
CUT_SIGMAS = 4.0
"""A normal input is cut off so many standard deviations away: 6e-5 of it is beyond."""
LEAST_BASE = 8
"""Rows of each base sample; a power of 2, as the Sobol sequence's balance needs."""


@dataclass(frozen=True)
class ScatteredInput:
    """A number that scatters about its nominal value, within `low` and `high`.

    `normal`: with standard deviation `std`, cut off at the ends; else uniform between them.
    """

    key: str
    nominal: float
    std: float
    low: float
    high: float
    normal: bool

    def at(self, unit: np.ndarray) -> np.ndarray:
        """Return values for uniform numbers in [0, 1], any shape."""
        if self.low == self.high:
            return np.full(np.shape(unit), self.nominal)
        if not self.normal:
            return self.low + unit * (self.high - self.low)
        from scipy.stats import truncnorm

        a, b = (self.low - self.nominal) / self.std, (self.high - self.nominal) / self.std
        drawn = truncnorm.ppf(unit, a, b, loc=self.nominal, scale=self.std)
        return np.clip(drawn, self.low, self.high)

    def tightened(self, factor: float) -> ScatteredInput:
        """Return the same input with `factor` times the scatter."""
        return ScatteredInput(
            self.key,
            self.nominal,
            self.std * factor,
            self.nominal + (self.low - self.nominal) * factor,
            self.nominal + (self.high - self.nominal) * factor,
            self.normal,
        )


def inputs_of(study: Study) -> tuple[ScatteredInput, ...]:
    """Return the design's [uncertainty] and the study's [tolerance]; a key of both takes the latter.

    Raises
    ------
    StudyError : nothing scatters, or a tolerance reaches beyond what can be built.
    """
    doubt = study.design.uncertainty
    modulus = study.design.material.flexspline.youngs_modulus_GPa
    stds = {
        MODULUS: modulus * doubt.youngs_modulus_pct / 100,
        CLEARANCE: doubt.flank_clearance_um,
        PLAY: doubt.radial_clearance_um,
    }
    for key, spread in study.file.tolerance.items():
        stds[key] = spread.std or 0.0
    inputs = []
    for key, std in stds.items():
        spread_or_none = study.file.tolerance.get(key)
        half = spread_or_none.plus_minus if spread_or_none else None
        if not std and half is None:
            continue
        inputs.append(_input(study, key, std, half))
    if not inputs:
        raise StudyError("tolerance", None, "nothing scatters: give [tolerance] or [uncertainty]")
    return tuple(inputs)


def _input(study: Study, key: str, std: float, half: float | None) -> ScatteredInput:
    nominal = value_at(study.design, key)
    assert nominal is not None  # `check` has seen that
    least, most = study.range_of(key)
    if key == PLAY and study.design.bearing.bearing_play_model == "involute":
        most = min(most, study.design.gear.bearing_play_limit_um)
    reach = half if half is not None else CUT_SIGMAS * std
    low, high = nominal - reach, nominal + reach
    if half is None:
        low, high = max(low, least), min(high, most)
        return ScatteredInput(key, nominal, std, low, high, True)
    for end in (low, high):
        try:
            with_values(study.design, {key: end})
        except DesignError as fault:
            raise StudyError(f'tolerance."{key}".plus_minus', half, f"too wide: {fault}") from None
    return ScatteredInput(key, nominal, half / 3**0.5, low, high, False)


def base_size(study: Study, k: int) -> int:
    """Return N: the largest power of two with N(k + 2) within `run.evaluations`.

    Raises
    ------
    StudyError : fewer than LEAST_BASE.
    """
    budget = study.file.run.evaluations
    least = LEAST_BASE * (k + 2)
    if budget < least:
        reason = f"must be at least {least}: {LEAST_BASE} for each of {k} inputs and two samples"
        raise StudyError("run.evaluations", budget, reason)
    return int(2 ** np.floor(np.log2(budget / (k + 2))))


def saltelli(inputs: tuple[ScatteredInput, ...], base: int, seed: int) -> np.ndarray:
    """Return points (base·(k + 2), k), block by block: A, A with each input from B, B."""
    from scipy.stats import qmc

    k = len(inputs)
    both = qmc.Sobol(2 * k, scramble=True, seed=seed).random(base)
    blocks = np.repeat(both[:, None, :k], k + 2, axis=1)
    number = np.arange(k)
    blocks[:, number + 1, number] = both[:, k:]
    blocks[:, -1] = both[:, k:]
    unit = blocks.reshape(-1, k)
    return np.column_stack([x.at(u) for x, u in zip(inputs, unit.T, strict=True)])


@dataclass(frozen=True)
class ScatteredDesigns(PlannedDesigns):
    """Designs of a tolerance study."""

    inputs: tuple[ScatteredInput, ...]

    @cached_property
    def over(self) -> Mapping[str, BaseDistribution]:
        """Optuna's distributions of the inputs."""
        from optuna.distributions import FloatDistribution

        return {x.key: FloatDistribution(x.low, x.high) for x in self.inputs}

    def task(self, values: Mapping[str, float]) -> Task:
        """Young's modulus is one for both parts' doubt, as in the backlash's standard deviation.

        Unless the study file says how the shaft's own scatters.
        """
        changed = linked(self.study, values)
        material = self.study.design.material
        shaft_varies = SHAFT_MODULUS in values or SHAFT_MODULUS in self.study.file.link
        if MODULUS in values and material.shaft is not None and not shaft_varies:
            ratio = values[MODULUS] / material.flexspline.youngs_modulus_GPa
            changed[SHAFT_MODULUS] = material.shaft.youngs_modulus_GPa * ratio
        return Task(self._tables, changed, self.solves, self.holes)


def scattered(study: Study, holes: HolesEffect | None) -> ScatteredDesigns:
    """Return the source of a tolerance study.

    Raises
    ------
    StudyError
    """
    inputs = inputs_of(study)
    for key, link in study.file.link.items():
        if key in {x.key for x in inputs}:
            reason = "the same key scatters by [tolerance] or the design's [uncertainty]; keep one"
            raise StudyError(f'link."{key}"', link.of, reason)
    base = base_size(study, len(inputs))
    points = saltelli(inputs, base, study.file.run.seed)
    solves = solves_of(study, ("torsion",))
    plan = Listed(tuple(x.key for x in inputs), points)
    return ScatteredDesigns(study, solves, plan, inputs, holes=holes)
