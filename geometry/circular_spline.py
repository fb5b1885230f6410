"""The circular spline: its rim, the working depth of its teeth, and assumed proportions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from flexspline.geometry.assumed import Assumed, taken_from
from flexspline.geometry.basic_rack import DEDENDUM
from flexspline.geometry.bounds import span
from flexspline.geometry.errors import DesignError
from flexspline.geometry.ranges import LENGTH_mm
from flexspline.geometry.share_range import share_faults

if TYPE_CHECKING:
    from flexspline.geometry.design import Design

OUTER_SHARE = 1.35
"""Outer diameter over pitch diameter: the median of one maker's component sets (CSF, sizes 14 to 58: 50, 60,
70, 85, 110, 135, 170, 195 mm, which is 1.32 to 1.41)."""
THINNEST_RIM = 0.02
"""Smallest rim outside the root circle, as a share of the pitch radius."""
DEEPEST = 1.34
"""Largest working depth over m(z2 − z1)/2: the withdrawal at 55°, where plain flanks of 20° begin to cut into
each other."""
SHALLOWEST = 0.1
"""Smallest working depth over m(z2 − z1)/2: teeth then touch only within 13° of the major axis."""

DEPTH_ROUNDING = 1e-3
"""Share by which a depth written with four digits may exceed the limit."""


@dataclass(frozen=True)
class CircularSpline:
    """Lengths in mm.

    Attributes
    ----------
    root : radius of the root circle.
    outer : radius.
    working_depth : largest withdrawal from full depth at which teeth touch.
    """

    root: float
    outer: float
    working_depth: float
    assumed: tuple[Assumed, ...]


def circular_spline(design: Design) -> CircularSpline:
    """What the design states, and proportions for the rest."""
    gear = design.gear
    pitch, stroke = gear.circular_spline_pitch_radius_mm, gear.centre_distance_mm
    assumed: list[Assumed] = []
    taken = taken_from(gear, "gear", assumed)
    diameter = taken(
        "circular_spline_diameter_mm",
        2 * max(OUTER_SHARE * pitch, _least_outer(design)),
        f"{OUTER_SHARE:g} pitch diameters, the median of eight catalogue sizes",
    )
    depth = taken(
        "working_depth_mm", DEEPEST * stroke, f"{DEEPEST:g} m(z2 - z1)/2, teeth of full height"
    )
    return CircularSpline(_root_radius(design), diameter / 2, depth, tuple(assumed))


def _root_radius(design: Design) -> float:
    gear = design.gear
    return gear.module_mm * (gear.teeth_circular_spline / 2 + DEDENDUM)


def _least_outer(design: Design) -> float:
    return _root_radius(design) + THINNEST_RIM * design.gear.circular_spline_pitch_radius_mm


def circular_spline_faults(design: Design) -> Iterator[DesignError]:
    """A rim that does not hold its teeth, teeth that do not meet, flanks that are not drawn."""
    gear = design.gear
    if gear.flanks == "drawn" and design.flexspline.teeth != "drawn":
        yield DesignError("gear.flanks", "drawn", 'needs flexspline.teeth = "drawn"')
    outer, least = gear.circular_spline_diameter_mm, 2 * _least_outer(design)
    if outer is not None and outer < least:
        yield DesignError(
            "gear.circular_spline_diameter_mm",
            outer,
            f"must be {span(least, LENGTH_mm.high, 4)} mm: the root circle's diameter is "
            f"{2 * _root_radius(design):.4g} mm",
        )
    stroke = gear.centre_distance_mm
    yield from share_faults(
        "gear.working_depth_mm",
        gear.working_depth_mm,
        (SHALLOWEST, DEEPEST),
        stroke,
        f"m(z2 - z1)/2 = {stroke:.4g} mm",
        DEPTH_ROUNDING,
    )
