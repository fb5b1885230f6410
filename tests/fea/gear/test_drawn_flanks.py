"""Gaps of drawn flanks: a rack by hand, and an involute pinion that rolls in its ring without any gap."""

from __future__ import annotations

from math import cos, pi, radians, sin, tan

import numpy as np
import pytest

from flexspline.fea.gear.drawn_flanks import DrawnFlanks
from flexspline.geometry.tooth import flank

ALPHA = radians(20)


def shapes(kind: str, module: float, teeth: tuple[int, int]) -> DrawnFlanks:
    """Heights of a module to both sides of the pitch circles."""
    heights = np.linspace(-module, module, 201)

    def half(count: int) -> np.ndarray:
        angle = flank(kind, module, count, ALPHA)  # type: ignore[arg-type]
        return np.array([r * angle(r) for r in (module * count / 2 + heights).tolist()])

    return DrawnFlanks(heights, half(teeth[0]), heights, half(teeth[1]), ALPHA)


def test_a_rack_tooth_by_hand() -> None:
    """y sin α − x cos α, less what the turn brings the tip nearer: β cos α (h − t tan α)."""
    module = 0.2
    rack = shapes("trapezoid", module, (20_000_000, 20_000_000))
    x, y, turn = np.array([0.0, 0.01]), np.array([0.0, 0.05]), np.array([0.0, 0.01])
    tip = module - (pi * module / 4 - module * tan(ALPHA)) * tan(ALPHA)
    expected = y * sin(ALPHA) - x * cos(ALPHA) - turn * cos(ALPHA) * tip
    assert rack.gap(x, y, turn) == pytest.approx(expected, abs=1e-6)


def test_involutes_roll_on_each_other_without_a_gap() -> None:
    """180 teeth in 220: the pinion rolls about its own centre; contact stays as long as teeth reach it."""
    module, teeth = 0.2, (180, 220)
    r1, r2 = (module * z / 2 for z in teeth)
    theta = np.radians(np.linspace(-1.0, 1.0, 9))
    space = theta * r1 / r2
    px, py = r2 - r1 + r1 * np.cos(theta), r1 * np.sin(theta)
    along = -px * np.sin(space) + py * np.cos(space)
    outwards = px * np.cos(space) + py * np.sin(space)
    gap = shapes("involute", module, teeth).gap(along, r2 - outwards, theta - space)
    # a circle's curvature differs by t²/2 (1/r1 − 1/r2) over half a tooth: 0.1 µm; straight flanks leave 4
    assert np.abs(gap).max() < 3e-4
    straight = shapes("trapezoid", module, teeth).gap(along, r2 - outwards, theta - space)
    assert np.abs(straight).max() > 10 * np.abs(gap).max()


def test_teeth_that_are_out_meet_nothing() -> None:
    rack = shapes("trapezoid", 0.2, (200, 202))
    assert np.isinf(rack.gap(np.array([0.0]), np.array([0.41]), np.array([0.0])))
