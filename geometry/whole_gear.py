"""Designs whose whole gear cannot be computed, although their parts can.

Teeth that do not stand on the ring, a stroke beyond small displacements, a play that takes the stroke.
"""

from __future__ import annotations

from collections.abc import Iterator

from flexspline.geometry.basic_rack import ADDENDUM, DEDENDUM
from flexspline.geometry.bounds import above, span
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.fields import UM_PER_MM
from flexspline.geometry.ranges import MODULE_mm

LARGEST_STROKE = 0.1
"""Largest stroke over the tube's inner radius. Ratios in catalogues begin at 30, which is a stroke of 0.033.
The model assumes small displacements: the square of 0.1 is 1 %."""


def require_whole_gear(design: Design) -> None:
    """Raises DesignError with the first reason why the design has no whole gear."""
    for fault in _faults(design):
        raise fault


def _faults(design: Design) -> Iterator[DesignError]:
    gear, f = design.gear, design.flexspline
    z1, stroke, ring = gear.teeth_flexspline, gear.centre_distance_mm, f.ring_radius
    height = ADDENDUM + DEDENDUM
    low, high = ring / (z1 / 2 + ADDENDUM), ring / (z1 / 2 - DEDENDUM - height)
    if high < MODULE_mm.low:
        least = 2 * (MODULE_mm.low * (z1 / 2 - DEDENDUM - height) - ring + f.inner_radius)
        yield DesignError(
            "flexspline.inner_diameter_mm",
            f.inner_diameter_mm,
            f"must be at least {above(least):.4g} mm: {z1} teeth of the smallest module, {MODULE_mm.low:g} "
            f"mm, do not stand on the ring, whose outer radius is {ring:.4g} mm",
        )
    elif not low < gear.module_mm <= high:
        yield DesignError(
            "gear.module_mm",
            gear.module_mm,
            f"must be {span(low, high, 4)} mm: {z1} teeth of that module do not stand on the ring, whose "
            f"outer radius is {ring:.4g} mm",
        )
    if stroke > LARGEST_STROKE * f.inner_radius:
        most = int(LARGEST_STROKE * f.inner_radius / gear.module_mm)  # z2 - z1 = 2 stroke/m is even
        room = "" if most < 1 else f"must be at most {z1 + 2 * most}: "
        yield DesignError(
            "gear.teeth_circular_spline",
            gear.teeth_circular_spline,
            f"{room}the stroke m(z2 - z1)/2 = {stroke:.4g} mm is more than {LARGEST_STROKE:g} of the tube's "
            f"inner radius, {f.inner_radius:.4g} mm, and displacements are no longer small",
        )
    bearing = design.bearing
    if bearing.radial_clearance_mm >= 2 * design.w0_mm:
        yield DesignError(
            "bearing.radial_clearance_um",
            bearing.radial_clearance_um,
            f"must be below {2 * UM_PER_MM * design.w0_mm:.4g} µm: twice the wave generator's stroke",
        )
