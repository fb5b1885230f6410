"""A whole gear's curve by hand: no contact solved."""

from __future__ import annotations

import numpy as np

from flexspline.geometry.assumed import Assumed
from flexspline.pipeline.gear.gear_curve import LOADING, GearCurve
from flexspline.pipeline.gear.gear_remarks import HalvedBalls
from flexspline.pipeline.gear.gear_terms import TIGHT

TERMS = ("shaft", "flexspline", "flank_clearance", "bearing_play", TIGHT)


def gear_curve(torque: float, angle: float, force: float, softening: float = 0.6) -> GearCurve:
    """θ ∝ T^softening up to a torque [N·m] and an angle [arcsec], teeth of a force [N]."""
    up = np.array(LOADING)
    loop = np.concatenate([up, up[-2::-1], -up, -up[-2::-1]])
    turned = np.sign(loop) * np.abs(loop) ** softening
    rad = angle / 206265
    phi = np.arange(-54.0, 55.0, 1.8)
    return GearCurve(
        0.15 * torque / rad, 0.5 * torque / rad, torque / rad, 0.15 * torque, 0.5 * torque, torque,
        0.1 * angle, 32, {"flexspline": 0.6, "shaft": 0.2, "teeth": 0.1, "bearing": 0.1},
        tuple((torque * loop).tolist()), tuple((angle * turned).tolist()),
        (Assumed("wave_generator.ball_count", 23.0, "usual"),), (),
        (HalvedBalls(23, 24),), 0.0,
        tuple(phi.tolist()), tuple((force * np.cos(np.radians(phi)) ** 4).tolist()),
        tuple(np.arange(0.0, 180.0, 15.0).tolist()), tuple([force] * 12),
        dict.fromkeys(TERMS, angle / 10) | {"total": angle / 2},
    )  # fmt: skip
