"""A creep test as a rig runs it: torque up in seconds, held for minutes; twist by superposition."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from hidden.gear import Gear, Rig

Kernel = Callable[[np.ndarray], np.ndarray]
"""Growth of twist after a unit step of torque, as a share of the elastic one, over time [s]."""
PARTS = 40
"""Steps into which a ramp is cut: of 2 s each is 0.05 s, far below the shortest time of a kernel."""


@dataclass(frozen=True)
class CreepTest:
    """Loads in `ramp_s`, holds for `hold_s`, `times` over, and back; read every `step_s`.

    `back` : the level between loads as a share of the peak: 0 unloads, −1 loads the other way.
    """

    peak_Nm: float
    ramp_s: float = 2.0
    hold_s: float = 600.0
    times: int = 3
    step_s: float = 0.5
    back: float = 0.0

    def corners(self) -> tuple[np.ndarray, np.ndarray]:
        """Times [s] and torques [N·m] between which the programme is straight."""
        time, torque = [0.0, 5.0], [0.0, 0.0]
        for _ in range(self.times):
            for level in (self.peak_Nm, self.back * self.peak_Nm):
                time += [time[-1] + self.ramp_s, time[-1] + self.ramp_s + self.hold_s]
                torque += [level, level]
        return np.array(time), np.array(torque)


def grown(kernel: Kernel, test: CreepTest, time: np.ndarray) -> np.ndarray:
    """∫ J(t − s) dT(s) [N·m], by small steps of torque (Boltzmann 1874)."""
    corners, levels = test.corners()
    out = np.zeros(len(time))
    for a, b, low, high in zip(corners, corners[1:], levels, levels[1:], strict=False):
        if high == low:
            continue
        for at in a + (b - a) * (np.arange(PARTS) + 0.5) / PARTS:
            later = time > at
            out[later] += (high - low) / PARTS * kernel(time[later] - at)
    return out


def logarithmic(percent: float, start_s: float) -> Kernel:
    """Creep by a share of the elastic twist for each decade, from `start_s` on (Andrade's α, log law)."""
    return lambda t: percent / 100 * np.log10(1 + t / start_s)


def standard_solid(percent: float, tau_s: float) -> Kernel:
    """Zener's standard linear solid: twist relaxes to `percent` more with one time."""
    return lambda t: percent / 100 * -np.expm1(-t / tau_s)


def written(
    test: CreepTest,
    kernel: Kernel,
    rig: Rig,
    gear: Gear,
    rng: np.random.Generator,
    noise_arcsec: float = 0.15,
    noise_share: float = 5e-4,
) -> str:
    """The record as CSV; noise of the torque as a share of its peak."""  # fmt: skip
    corners, levels = test.corners()
    time = np.arange(0, corners[-1], test.step_s)
    torque = np.interp(time, corners, levels)
    angle = gear.zero + gear.compliance * (torque + grown(kernel, test, time))
    angle += gear.gap / 2 * np.sign(torque) + noise_arcsec * rng.normal(size=len(time))
    read = torque + noise_share * test.peak_Nm * rng.normal(size=len(time))
    rows = (f"{t:.3f},{m:.6f},{a:.4f}" for t, m, a in zip(time, read, angle, strict=True))
    return "time_s,torque_Nm,angle_arcsec\n" + "\n".join(rows) + "\n"
