"""Closed forms of a round tube."""

from __future__ import annotations

from math import pi


def polar_moment_mm4(outer_radius_mm: float, inner_radius_mm: float) -> float:
    """J = π(R⁴ − r⁴)/2 [mm⁴], which resists torsion: Coulomb.

    Examples
    --------
    A solid bar of 10 mm radius, π/2·10⁴:

    >>> round(polar_moment_mm4(10.0, 0.0), 1)
    15708.0
    """
    return pi / 2 * (outer_radius_mm**4 - inner_radius_mm**4)
