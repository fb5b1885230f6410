"""Effects in the readings and in the teeth's position: kinematic error, an offset of the torque."""

from __future__ import annotations

import numpy as np

from hidden.effect import CannotShowError, Hidden, Setting, nothing
from hidden.elastic import harmonics, periodic, tells_harmonics

SEEN = 8
"""Samples that an offset of the torque must put on the wrong side of the gap: fewer are outliers."""


def draw_kinematic(s: Setting, rng: np.random.Generator) -> Hidden:
    """Position error with harmonics 1, 2, 4 of the wave generator's angle, one leading."""
    if not tells_harmonics(s.program.position, s.program.cycle):
        raise CannotShowError("too few positions for their harmonics")
    size = s.windup * s.size(0.04, 0.1, 0.25, rng)
    amplitude, phase, said = harmonics(rng)
    return Hidden(
        "kinematic_error",
        size,
        f"position error ± {size:.2f}″, harmonics {said}",
        lambda p, g: size * periodic(p.position, amplitude, phase),
    )


def draw_torque_offset(s: Setting, rng: np.random.Generator) -> Hidden:
    """The torque reading is 1.5 to 12 % of the largest torque off, either way."""
    offset = float(s.program.peak * s.size(0.02, 0.045, 0.09, rng) * rng.choice([-1, 1]))
    torque = s.program.torque[s.program.rows]
    if np.count_nonzero(np.sign(torque) != np.sign(torque + offset)) < SEEN:
        raise CannotShowError("too few samples between the gap and where it seems to be")
    return Hidden("torque_offset", offset, f"reading {offset:+.3f} N·m", nothing, offset)
