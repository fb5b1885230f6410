"""Micro-slip of a bolted or splined joint whose friction never lets go altogether.

Jenkins elements side by side (Iwan 1966), each a spring k that slips at its own displacement φ; their
stiffness is spread as a power law, dk ∝ φ^χ dφ with −1 < χ < 0, up to displacements beyond any of the record
(Segalman, J. Appl. Mech. 72, 752 (2005)). The joint's displacement x carries the torque, T = Σ k·(x −
slider), and is solved for step by step; nothing is said of operators on the torque. At small loads the loss
grows as T^(χ + 3).
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from hidden.effect import Hidden, Setting
from hidden.gear import Gear
from hidden.program import Program

SPRINGS = 80
"""Of a joint; with 400 the loop's width changes by less than 0.5 %."""
LOOP = 60
"""Steps of a quarter of the closed loop whose width is the magnitude."""


class Joint:
    """Jenkins elements in parallel: displacement x for torque, in shares of the largest of both."""

    def __init__(self, chi: float, capacity: float) -> None:
        """`capacity` : torque at which all would slip, in shares of the largest; the first stiffness is 1."""
        edge = np.linspace(0, 1, SPRINGS + 1) ** 3  # fine where the first ones slip
        self.spring = np.diff(edge ** (chi + 1))
        self.slips_at = (edge[1:] + edge[:-1]) / 2
        self.slips_at *= capacity / float(self.spring @ self.slips_at)
        self.slider, self.x = np.zeros(SPRINGS), 0.0

    def _torque(self, x: float) -> float:
        return float(self.spring @ np.clip(x - self.slider, -self.slips_at, self.slips_at))

    def move(self, torque: float) -> float:
        """The displacement under a torque, reached straight from where the joint stood."""
        far = self.x + np.array([-1.0, 1.0]) * (2 * self.slips_at[-1] + 1)
        self.x = float(brentq(lambda x: self._torque(x) - torque, *far, xtol=1e-12))
        stretch = np.clip(self.x - self.slider, -self.slips_at, self.slips_at)
        self.slider = self.x - stretch
        return self.x


def draw_micro_slip(s: Setting, rng: np.random.Generator) -> Hidden:
    """The joint's displacement beyond its first spring's: width 4 to 25 % of the wind-up."""
    chi = rng.uniform(-0.7, -0.1)
    capacity = rng.uniform(1.5, 5.0)
    width = s.windup * s.size(0.04, 0.1, 0.25, rng)
    one = loop_width(chi, capacity)
    peak = s.program.peak

    def angle(p: Program, gear: Gear) -> np.ndarray:
        joint = Joint(chi, capacity)
        load = p.torque / peak
        return width / one * (np.array([joint.move(q) for q in load]) - load)

    law = f"micro-slip ∝ φ^{chi:.2f}, all of it slips at {capacity:.1f} times the peak"
    return Hidden("friction_hysteresis", width, f"{law}, width {width:.2f}″", angle)


def loop_width(chi: float, capacity: float) -> float:
    """Width at zero torque of the third loop ± 1."""
    leg = np.linspace(0, 1, LOOP + 1)[1:]
    loop = np.tile(np.concatenate([leg, 1 - leg, -leg, leg - 1]), 3)
    joint = Joint(chi, capacity)
    out = np.array([joint.move(q) for q in loop])[-4 * LOOP :]
    return float(out[2 * LOOP - 1] - out[-1])
