"""Effects in the readings and in the teeth's position: kinematic error, an offset of the torque."""

from __future__ import annotations

import numpy as np

from hidden.effect import CannotShowError, Hidden, Setting, nothing
from hidden.elastic import harmonics, periodic, tells_harmonics


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
    """The torque reading is 2 to 15 % of the largest torque off, either way."""
    offset = s.program.peak * s.size(0.025, 0.055, 0.12, rng) * rng.choice([-1, 1])
    return Hidden("torque_offset", offset, f"reading {offset:+.3f} N·m", nothing, offset)
