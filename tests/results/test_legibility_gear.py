"""The whole gear's charts can be read, whatever gear they show."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from legibility import drawn_figures, faults

from flexspline.pipeline.gear import LOADING, GearCurve
from flexspline.results.figures.gear import write_gear_angle, write_gear_loads


def curve(torque: float, angle: float, force: float, softening: float = 0.6) -> GearCurve:
    """θ ∝ T^softening up to a torque [N·m] and an angle [arcsec], teeth of a force [N]."""
    up = np.array(LOADING)
    loop = np.concatenate([up, up[-2::-1], -up, -up[-2::-1]])
    turned = np.sign(loop) * np.abs(loop) ** softening
    rad = angle / 206265
    phi = np.arange(-54.0, 55.0, 1.8)
    return GearCurve(
        0.15 * torque / rad, 0.5 * torque / rad, torque / rad, 0.15 * torque, 0.5 * torque, torque,
        0.1 * angle, 32, {"flexspline": 0.6, "shaft": 0.2, "teeth": 0.1, "bearing": 0.1},
        tuple((torque * loop).tolist()), tuple((angle * turned).tolist()), (), (),
        tuple(phi.tolist()), tuple((force * np.cos(np.radians(phi)) ** 4).tolist()),
        tuple(np.arange(0.0, 180.0, 15.0).tolist()), tuple([force] * 12),
    )  # fmt: skip


CURVES = {
    "usual": curve(23.2, 474.0, 108.0),
    "huge": curve(9.6e5, 2.1e-3, 4.4e7),
    "tiny": curve(1.3e-7, 8.8e4, 3e-6),
    "straight": curve(52.0, 600.0, 300.0, softening=1.0),
    "a gap first": curve(31.0, 400.0, 200.0, softening=0.05),
}


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("write", [write_gear_angle, write_gear_loads])
def test_gear_charts(tmp_path: Path, name: str, write) -> None:
    with drawn_figures() as found:
        write(tmp_path / "a.png", CURVES[name])
    (figure,) = found
    assert faults(figure) == []
