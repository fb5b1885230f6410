"""Checks of drawn teeth: root within the pitch circle, a gap there, and a tip that is not pointed."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, pi, radians

from flexspline.geometry.bounds import beside, last_that, span
from flexspline.geometry.check_flexspline import thickest_ring
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.fields import SMALLEST_MM
from flexspline.geometry.module_fit import fitting_module_mm
from flexspline.geometry.outline import SAME_mm
from flexspline.geometry.ranges import MODULE_mm, PRESSURE_ANGLE_deg
from flexspline.geometry.tooth import half_thickness, tip_radius

INSIDE_END_SHARE = 1e-6
"""Of a module, by which ends of ranges lie inside what is possible: less than the digits in which they are
printed."""
SMALLEST_LAND = 0.02
"""Half width of tip and root, in modules, below which a tooth counts as pointed."""


def ring_ends(design: Design) -> tuple[float, float]:
    """Least and largest ring thickness with which teeth can be drawn [mm]; 0 and inf where none are to be.

    The root circle lies within the pitch circle, and the flanks leave a gap there.
    """
    f, gear = design.flexspline, design.gear
    pitch, land = gear.pitch_radius_mm, SMALLEST_LAND * gear.module_mm
    if f.teeth == "none" or pitch - land <= f.wall_radius + SAME_mm:
        return 0.0, inf
    margin = INSIDE_END_SHARE * gear.module_mm
    low, high = f.wall_radius, pitch - land - margin
    if _gap(design, low) < land:
        low = last_that(lambda r: _gap(design, r) > land, high, low, margin)
    return low - f.inner_radius, high - f.inner_radius


def least_module_mm(design: Design) -> float:
    """The module whose pitch circle lies around the tube, where teeth are drawn; else 0."""
    if design.flexspline.teeth == "none":
        return 0.0
    least = design.flexspline.wall_radius / (design.gear.teeth_flexspline / 2 - SMALLEST_LAND)
    return least * (1 + INSIDE_END_SHARE) + SAME_mm


def tooth_faults(design: Design) -> Iterator[DesignError]:
    """What keeps the teeth from being drawn; nothing where none are asked for."""
    if design.flexspline.teeth == "none":
        return
    f, gear = design.flexspline, design.gear
    pitch, land = gear.pitch_radius_mm, SMALLEST_LAND * gear.module_mm
    if pitch - land <= f.wall_radius + SAME_mm:
        room = span(least_module_mm(design), MODULE_mm.high, 4)
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
            f"{gear.pressure_angle_deg:g}° leave a gap between teeth there; gear.module_mm = "
            f"{fitting_module_mm(design):.3g} puts the roots on this ring",
        )
        return
    if _land(design, radians(gear.pressure_angle_deg)) < land:
        largest = last_that(
            lambda angle: _land(design, radians(angle)) >= land,
            PRESSURE_ANGLE_deg.low,
            gear.pressure_angle_deg,
            1e-4,  # degrees: the end is told in six digits
        )
        yield DesignError(
            "gear.pressure_angle_deg",
            gear.pressure_angle_deg,
            f"must be {span(PRESSURE_ANGLE_deg.low, largest)} for teeth to be drawn: beyond, they are "
            f"pointed below the tip circle, radius {tip_radius(design):.4g} mm",
        )


def _gap(design: Design, r: float) -> float:
    """Half the gap between two teeth along the circle [mm]."""
    return r * (pi / design.gear.teeth_flexspline - half_thickness(design)(r))


def _land(design: Design, pressure_angle: float) -> float:
    """Half the tooth's width at its tip [mm]."""
    tip = tip_radius(design)
    return tip * half_thickness(design, pressure_angle)(tip)
