"""A gear that warms through its housing: two thermal masses behind the sensor, not always settled at first.

The housing follows the air that the sensor reads, the gear the housing; the gap follows the gear. The rig
stood overnight in one case of two; else the gear is warmer or colder than the air when the record begins.
"""

from __future__ import annotations

import numpy as np

from hidden.effect import CannotShowError, Hidden, Setting
from hidden.gear import Gear
from hidden.program import Program
from hidden.surroundings import REFERENCE_C


def draw_thermal_mass(s: Setting, rng: np.random.Generator) -> Hidden:
    """Time constants 3 to 25 % of the record, the second 10 to 100 % of the first; up to 4 K off at first."""
    span = float(np.ptp(s.program.temperature))
    if span < 4:
        raise CannotShowError("no temperature to speak of")
    reach = float(np.abs(s.program.temperature - REFERENCE_C).max())
    per_kelvin = s.windup * s.size(0.05, 0.12, 0.3, rng) / reach
    if rng.random() < 0.4:
        per_kelvin = -min(per_kelvin, 0.9 * s.gear.gap / reach)
    first = s.program.time[-1] * float(np.exp(rng.uniform(np.log(0.03), np.log(0.25))))
    second = first * rng.uniform(0.1, 1.0)
    off = float(rng.uniform(1, 4) * rng.choice([-1, 1])) if rng.random() < 0.5 else 0.0

    def angle(p: Program, g: Gear) -> np.ndarray:
        warm = _gear_C(p.time, p.temperature, (first, second), off)
        return per_kelvin * (warm - REFERENCE_C) * np.sign(p.torque) / 2

    said = (
        f"gap {per_kelvin:+.3f}″/K behind {first:.0f} and {second:.0f} s, {off:+.1f} K at the start"
    )
    return Hidden("thermal_clearance", per_kelvin, said, angle)


def _gear_C(
    time: np.ndarray, air: np.ndarray, constants: tuple[float, float], off_K: float
) -> np.ndarray:
    """Gear's temperature [°C]: dh/dt = (air − h)/τ₁, dg/dt = (h − g)/τ₂, by midpoint in short steps."""
    out = np.empty(len(time))
    state = np.array([air[0] + off_K, air[0] + off_K])
    out[0] = state[1]
    shortest = min(constants)
    for k in range(1, len(time)):
        span = time[k] - time[k - 1]
        parts = int(span / (0.1 * shortest)) + 1
        h = span / parts

        def flow(y: np.ndarray, at: float, k: int = k, span: float = span) -> np.ndarray:
            outside = air[k - 1] + (air[k] - air[k - 1]) * at / span
            return np.array([(outside - y[0]) / constants[0], (y[0] - y[1]) / constants[1]])

        for i in range(parts):
            half = state + flow(state, i * h) * h / 2
            state = state + flow(half, (i + 0.5) * h) * h
        out[k] = state[1]
    return out
