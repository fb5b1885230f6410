"""A gear on its rig with programme and noise, before anything is hidden in it."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace

import numpy as np

from hidden.case import Case
from hidden.effect import Hidden, Setting, nothing
from hidden.elastic import fixes_harmonics
from hidden.gear import Gear, Rig, draw_gear, draw_rig
from hidden.noise import Noise, draw_noise
from hidden.program import Plan, draw_program
from hidden.record import Unit, as_csv, measure

AGAIN = 1
"""Beside a case's seed: of the noise of its second measurement."""


class Bench:
    """A rig with its units, programme and noise drawn; effects come later."""

    def __init__(self, plan: Plan, rng: np.random.Generator, units: int = 1) -> None:
        self.rig: Rig = draw_rig(rng)
        windup = np.exp(rng.uniform(np.log(10), np.log(400)))
        peak = float(np.clip(windup / self.rig.compliance, 0.5, 70))
        self.program = draw_program(plan, peak, rng)
        self.gears: list[Gear] = [draw_gear(self.rig, rng) for _ in range(units)]
        self.noise: Noise = draw_noise(self.rig.compliance * peak, self.program, rng)
        self.rng = rng

    def setting(self, level: int) -> Setting:
        return Setting(self.rig, self.gears[0], self.program, level)

    def measured(self, hidden: tuple[Hidden, ...], only: int | None = None) -> list[Unit]:
        """All units, or the effects in one of them only."""
        still = tuple(replace(h, angle=nothing, reading_Nm=0.0) for h in hidden)
        return [
            measure(self.rig, g, self.program, still if only not in (None, k) else hidden,
                    self.noise, self.rng)
            for k, g in enumerate(self.gears)
        ]  # fmt: skip

    def _unsized(self) -> frozenset[str]:
        fixed = fixes_harmonics(self.program.position)
        return frozenset() if fixed else frozenset({"kinematic_error", "position_stiffness"})

    def case(self, kind: str, hidden: tuple[Hidden, ...], units: list[Unit], **more) -> Case:
        """The case of what was measured; where a cause is hidden, measured again with other noise."""
        writing = deepcopy(self.rng)  # the same header, clock and order of columns
        said = "; ".join([*(h.law for h in hidden), self.program.said, self.noise.said])
        order = sorted(range(len(hidden)), key=lambda k: -float(np.std(units[0].effects[k])))
        truth = tuple((hidden[k].cause, hidden[k].magnitude) for k in order)
        csv = as_csv(units, self.rng)
        again = ""
        if kind in ("single", "pair", "triple"):
            noise = np.random.default_rng([*more["seed"], AGAIN])
            repeated = [
                measure(self.rig, g, self.program, hidden, self.noise, noise) for g in self.gears
            ]
            again = as_csv(repeated, writing)
        return Case(
            kind=kind, csv=csv, again=again, design=self.rig.toml,
            K_b=self.rig.K_b, K_e=self.rig.K_e,
            truth=() if kind == "foreign" else truth,
            said=f"{len(units)} units, {said}" if len(units) > 1 else said,
            units=tuple(units), rig=self.rig, unsized=self._unsized(),
            **({"expected": frozenset(), "tolerated": frozenset(), "decidable": True} | more),
        )  # fmt: skip
