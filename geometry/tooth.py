"""Half a tooth of the flexspline with the rim under it, in polar coordinates, and when it exists.

The cell reaches from the tooth's centre (φ = 0) to the space's (φ = π/z1) and from the inner surface
to the tip, one module above the pitch circle; the root is where the design puts it, at
Ri + ring_thickness. Its corners are sharp. Every boundary but the flank is a coordinate line.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import acos, asin, cos, inf, pi, radians, sin, tan
from typing import Literal

from flexspline.geometry.basic_rack import ADDENDUM
from flexspline.geometry.bounds import beside, span
from flexspline.geometry.check_flexspline import thickest_ring
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.fields import SMALLEST_MM
from flexspline.geometry.outline import SAME, Meridian, Point, Segment
from flexspline.geometry.ranges import MODULE_mm, PRESSURE_ANGLE_deg

SMALLEST_LAND = 0.02
"""Half width of tip and root, in modules, below which a tooth counts as pointed."""
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
            if max(abs(end[0] - start[0]), abs(end[1] - start[1])) > SAME:
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
    """The cell of a design whose teeth can be drawn (`tooth_faults` finds none)."""
    f, psi = design.flexspline, half_thickness(design)
    radii = _chords(psi, f.ring_radius, tip_radius(design), CHORD_ERROR * design.gear.module_mm)
    flank = tuple((r, psi(r)) for r in reversed([f.ring_radius, *radii]))
    return ToothCell(f.inner_radius, pi / design.gear.teeth_flexspline, flank)


def _chords(psi: Callable[[float], float], low: float, high: float, allowed: float) -> list[float]:
    """Upper ends [mm] of the chords between two radii, none farther off the flank than allowed.

    Two places are compared, as the flank may have a kink or a turning point.
    """
    length = high - low
    apart = (
        (low + part * length)
        * abs(psi(low + part * length) - (1 - part) * psi(low) - part * psi(high))
        for part in (0.5, 0.75)
    )
    if max(apart) <= allowed:
        return [high]
    middle = (low + high) / 2
    return _chords(psi, low, middle, allowed) + _chords(psi, middle, high, allowed)


def ring_ends(design: Design) -> tuple[float, float]:
    """Least and largest ring thickness with which teeth can be drawn [mm]; 0 and inf where none are to be.

    The root circle lies within the pitch circle, and the flanks leave a gap there.
    """
    f, gear = design.flexspline, design.gear
    pitch, land = gear.module_mm * gear.teeth_flexspline / 2, SMALLEST_LAND * gear.module_mm
    if f.teeth == "none" or pitch - land <= f.wall_radius + SAME:
        return 0.0, inf
    margin = 1e-6 * gear.module_mm  # below the digits in which the ends are told
    low, high = f.wall_radius, pitch - land - margin
    if _gap(design, low) < land:
        inside, outside = high, low
        while inside - outside > margin:
            middle = (inside + outside) / 2
            inside, outside = (middle, outside) if _gap(design, middle) > land else (inside, middle)
        low = inside
    return low - f.inner_radius, high - f.inner_radius


def tooth_faults(design: Design) -> Iterator[DesignError]:
    """What keeps the teeth from being drawn; nothing where none are asked for."""
    if design.flexspline.teeth == "none":
        return
    f, gear = design.flexspline, design.gear
    pitch, land = gear.module_mm * gear.teeth_flexspline / 2, SMALLEST_LAND * gear.module_mm
    if pitch - land <= f.wall_radius + SAME:
        least = f.wall_radius / (gear.teeth_flexspline / 2 - SMALLEST_LAND)
        room = span(least * (1 + 1e-6) + SAME, MODULE_mm.high, 4)
        circles = (
            f"the pitch circle, radius {pitch:.4g} mm, lies within the tube, radius "
            f"{f.wall_radius:.4g} mm"
        )
        if room is None:
            yield DesignError("flexspline.teeth", f.teeth, f'must be "none": {circles}')
        else:
            reason = f"must be {room} mm for teeth to be drawn: {circles}"
            yield DesignError("gear.module_mm", gear.module_mm, reason)
        return
    low, high = ring_ends(design)
    if f.ring_radius >= pitch - land or _gap(design, f.ring_radius) < land:
        wall = f.wall_thickness_mm
        room = beside(
            wall, "wall_thickness_mm", SMALLEST_MM, max(low, wall), min(high, thickest_ring(f))
        )
        if not room:
            reason = (
                f'must be "none": teeth need a ring_thickness_mm of {low:.4g} to {high:.4g} mm, and wall '
                f"and length leave {wall:.4g} to {thickest_ring(f):.4g} mm"
            )
            yield DesignError("flexspline.teeth", f.teeth, reason)
            return
        yield DesignError(
            "flexspline.ring_thickness_mm",
            f.ring_thickness_mm,
            f"must be {room} mm for teeth to be drawn: the root circle, radius {f.ring_radius:.4g} mm, "
            f"must lie within the pitch circle, m z1/2 = {pitch:.4g} mm, and flanks of "
            f"{gear.pressure_angle_deg:g}° leave a gap between teeth there",
        )
        return
    if _land(design, radians(gear.pressure_angle_deg)) < land:
        small, large = PRESSURE_ANGLE_deg.low, gear.pressure_angle_deg
        while large - small > 1e-4:  # degrees: the end is told in six digits
            middle = (small + large) / 2
            pointed = _land(design, radians(middle)) < land
            small, large = (small, middle) if pointed else (middle, large)
        yield DesignError(
            "gear.pressure_angle_deg",
            gear.pressure_angle_deg,
            f"must be {span(PRESSURE_ANGLE_deg.low, small)} for teeth to be drawn: beyond, they are "
            f"pointed below the tip circle, radius {tip_radius(design):.4g} mm",
        )


def _gap(design: Design, r: float) -> float:
    """Half the gap between two teeth along the circle [mm]."""
    return r * (pi / design.gear.teeth_flexspline - half_thickness(design)(r))


def _land(design: Design, pressure_angle: float) -> float:
    """Half the tooth's width at its tip [mm]."""
    tip = tip_radius(design)
    return tip * half_thickness(design, pressure_angle)(tip)
