"""Half a tooth of the flexspline with the rim under it, in polar coordinates.

The cell reaches from the tooth's centre (φ = 0) to the space's (φ = π/z1) and from the inner surface
to the tip, one module above the pitch circle; the root is where the design puts it, at
Ri + ring_thickness. Its corners are sharp. Every boundary but the flank is a coordinate line.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, asin, cos, pi, radians, sin, tan
from typing import Literal

from flexspline.geometry.basic_rack import ADDENDUM
from flexspline.geometry.design import Design
from flexspline.geometry.outline import Meridian, Point, SAME_mm, Segment

CHORD_ERROR = 3e-4
"""Of the flank, in modules: it moves the equivalent thickness by less than one part in 1e4."""


@dataclass(frozen=True)
class ToothCell:
    """Half a pitch of the toothed ring.

    Attributes
    ----------
    inner : Ri [mm].
    half_pitch : π/z1 [rad].
    flank : points (r [mm], φ [rad]) from the tip to the root; a single one at φ = half_pitch makes a
        plain ring of that outer radius.
    """

    inner: float
    half_pitch: float
    flank: tuple[Point, ...]

    @property
    def tip(self) -> float:
        """Radius [mm]."""
        return self.flank[0][0]

    @property
    def root(self) -> float:
        """Radius [mm]."""
        return self.flank[-1][0]

    @property
    def unroll(self) -> float:
        """ρ [mm]: the outline's second coordinate is ρφ."""
        return self.root

    @property
    def root_corner(self) -> Point:
        """(r, ρφ) of the notch where the flank meets the root [mm]."""
        return self.root, self.unroll * self.flank[-1][1]

    @property
    def outline(self) -> Meridian:
        """Closed, counter-clockwise, in the plane (r, ρφ) [mm].

        Patches: `tooth` (its centre plane), `space` (the gap's), `seat` (the inner surface).
        """
        rho, top = self.unroll, self.unroll * self.half_pitch
        flank = [(r, rho * phi) for r, phi in self.flank]
        corners: list[tuple[Point, str | None]] = [
            ((self.inner, 0.0), "tooth"),
            ((self.tip, 0.0), None),
            *((p, None) for p in flank),
            ((self.root, top), "space"),
            ((self.inner, top), "seat"),
        ]
        segments = []
        for i, (start, patch) in enumerate(corners):
            end = corners[(i + 1) % len(corners)][0]
            if max(abs(end[0] - start[0]), abs(end[1] - start[1])) > SAME_mm:
                segments.append(Segment(start, end, patch=patch))
        return Meridian(tuple(segments))


def half_thickness(design: Design, pressure_angle: float | None = None) -> Callable[[float], float]:
    """ψ(r) [rad]: half the angle that the tooth fills at a radius [mm].

    Standard teeth, half a pitch thick on the pitch circle rp = m z1/2. Involute:
    ψ = π/(2 z1) + inv α − inv α_r with cos α_r = rp cos α / r, radial below the base circle.
    Trapezoid: the involute's tangent at the pitch point, ψ = π/(2 z1) − α + arcsin(rp sin α / r).
    `pressure_angle` [rad] stands in for the design's.
    """
    gear = design.gear
    alpha = radians(gear.pressure_angle_deg) if pressure_angle is None else pressure_angle
    return flank(design.flexspline.tooth_flank, gear.module_mm, gear.teeth_flexspline, alpha)


def flank(
    kind: Literal["involute", "trapezoid"], module_mm: float, teeth: int, pressure_angle: float
) -> Callable[[float], float]:
    """The same of any number of teeth: an internal gear's spaces are the teeth of an external one [rad]."""
    alpha, pitch, at_pitch = pressure_angle, module_mm * teeth / 2, pi / (2 * teeth)
    base = pitch * cos(alpha)

    def involute(r: float) -> float:
        beyond = acos(min(1.0, base / r))
        return at_pitch + (tan(alpha) - alpha) - (tan(beyond) - beyond)

    def trapezoid(r: float) -> float:
        return at_pitch - alpha + asin(min(1.0, pitch * sin(alpha) / r))

    return involute if kind == "involute" else trapezoid


def tip_radius(design: Design) -> float:
    """m z1/2 + m [mm]."""
    return design.gear.module_mm * (design.gear.teeth_flexspline / 2 + ADDENDUM)


def tooth_cell(design: Design) -> ToothCell:
    """The cell of a design whose teeth can be drawn (`geometry.check_tooth` finds no fault)."""
    f, psi = design.flexspline, half_thickness(design)
    radii = _chords(psi, f.ring_radius, tip_radius(design), CHORD_ERROR * design.gear.module_mm)
    flank = tuple((r, psi(r)) for r in reversed([f.ring_radius, *radii]))
    return ToothCell(f.inner_radius, pi / design.gear.teeth_flexspline, flank)


def _chords(psi: Callable[[float], float], low: float, high: float, allowed: float) -> list[float]:
    """Upper ends [mm] of the chords between two radii, none farther off the flank than allowed.

    Two places are compared, as the flank may have a kink or a turning point.
    """
    length = high - low
    deviations = (
        (low + part * length)
        * abs(psi(low + part * length) - (1 - part) * psi(low) - part * psi(high))
        for part in (0.5, 0.75)
    )
    if max(deviations) <= allowed:
        return [high]
    middle = (low + high) / 2
    return _chords(psi, low, middle, allowed) + _chords(psi, middle, high, allowed)
