"""Friction ahead of the gap, by the balance of torques at the output: bearing or seal, then teeth.

The output at angle x carries what the teeth give back, (x ∓ ½ gap)/c beyond the gap and nothing within it,
and the friction F of its bearing, a function of x and of how x got there. Torque T = teeth + F is solved for
x step by step. Nothing is said of play operators in torque: they come out, nearly.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from hidden.effect import Hidden, Setting
from hidden.friction import draw_friction
from hidden.gear import Gear
from hidden.program import Program

SHARES = (0.035, 0.08, 0.17)
"""Friction torque at the three levels, of the largest torque, within a factor of 1.35: 2.6 to 23 %."""
LOOP = 200
"""Steps of a quarter of the closed loop whose width is the magnitude."""


class Bearing(ABC):
    """Friction torque of the output's bearing, as a share of its largest; x in shares of the wind-up."""

    @abstractmethod
    def friction(self, x: float) -> float:
        """At x, reached straight from where the output last stood."""

    @abstractmethod
    def stand(self, x: float) -> None:
        """The output now stands there."""


class MaxwellSlip(Bearing):
    """Springs that slip, side by side: the quasi-static generalised Maxwell-slip model (Lampaert 2003)."""

    def __init__(self, reach: np.ndarray, weight: np.ndarray) -> None:
        self.reach, self.weight = reach, weight
        self.stretch, self.at = np.zeros(len(reach)), 0.0

    def _stretched(self, x: float) -> np.ndarray:
        return np.clip(self.stretch + (x - self.at), -self.reach, self.reach)

    def friction(self, x: float) -> float:
        return float(self.weight @ (self._stretched(x) / self.reach))

    def stand(self, x: float) -> None:
        self.stretch, self.at = self._stretched(x), x


class Bristles(Bearing):
    """LuGre without rate (Canudas de Wit 1995): dF = (1 − F·sgn dx)/δ·dx, exact along a straight way."""

    def __init__(self, reach: float) -> None:
        self.reach, self.value, self.at = reach, 0.0, 0.0

    def friction(self, x: float) -> float:
        side = np.sign(x - self.at)
        return float(side + (self.value - side) * np.exp(-abs(x - self.at) / self.reach))

    def stand(self, x: float) -> None:
        self.value, self.at = self.friction(x), x


def draw_friction_ahead(s: Setting, rng: np.random.Generator) -> Hidden:
    """Friction torque 2.6 to 23 % of the largest, in one case of four with ordinary friction beside it."""
    share = s.size(*SHARES, rng)
    seed = int(rng.integers(2**31))
    law = _bearing(seed)[1]
    gear, peak = s.gear, s.program.peak
    width = s.windup * loop_width(_bearing(seed)[0], share)
    beside = draw_friction(replace(s, level=0), rng) if rng.random() < 0.25 else None

    def at_output(p: Program, g: Gear) -> np.ndarray:
        return s.windup * output(_bearing(seed)[0], share, p.torque / peak, g.gap / s.windup)

    def teeth(p: Program, g: Gear) -> np.ndarray:
        x = at_output(p, g)
        return np.sign(x) * np.maximum(np.abs(x) - g.gap / 2, 0.0) / s.windup * peak

    def angle(p: Program, g: Gear) -> np.ndarray:
        x = at_output(p, g)
        more = x - g.compliance * p.torque - g.gap * np.sign(p.torque) / 2
        return more + (0.0 if beside is None else beside.angle(p, g))

    said = f"friction {100 * share:.1f} % of the torque ahead of a gap of {gear.gap:.1f}″, {law}"
    if beside is not None:
        width, said = width + beside.magnitude, f"{said}, and {beside.law}"
    return Hidden("friction_hysteresis", width, said, angle, crosses=True, teeth=teeth)


def output(bearing: Bearing, share: float, load: np.ndarray, gap: float) -> np.ndarray:
    """Angle of the output (n,) for torques `load` (n,): wind-up 1 at torque 1, friction `share`."""
    out = np.empty(len(load))
    for k, torque in enumerate(load):

        def balance(x: float, torque: float = torque) -> float:
            teeth = np.sign(x) * max(abs(x) - gap / 2, 0.0)
            return teeth + share * bearing.friction(x) - torque

        far = abs(torque) + share + gap / 2 + 1e-6
        out[k] = brentq(balance, -far, far, xtol=1e-9)
        bearing.stand(out[k])
    return out


def loop_width(bearing: Bearing, share: float) -> float:
    """Width at zero torque of the third loop ± 1, without a gap."""
    leg = np.linspace(0, 1, LOOP + 1)[1:]
    loop = np.concatenate([leg, 1 - leg, -leg, leg - 1])
    out = output(bearing, share, np.tile(loop, 3), 0.0)[-4 * LOOP :]
    return float(out[2 * LOOP - 1] - out[-1])


def _bearing(seed: int) -> tuple[Bearing, str]:
    """A fresh bearing, the same for the same seed, and its law in words."""
    rng = np.random.default_rng(seed)
    reach = float(np.exp(rng.uniform(np.log(0.002), np.log(0.03))))
    if rng.random() < 0.4:
        return Bristles(reach), f"bristles {reach:.4f} of the wind-up"
    n = int(rng.integers(1, 6))
    each = reach * np.exp(rng.uniform(-1, 1, n))
    said = f"{n} slipping springs, {each.min():.4f}…{each.max():.4f} of the wind-up"
    return MaxwellSlip(each, rng.dirichlet(np.full(n, 2.0))), said
