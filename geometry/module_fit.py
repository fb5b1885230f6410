"""Whether module and teeth belong to the ring: a slipped decimal point is told from a ring that is off."""

from __future__ import annotations

from flexspline.geometry.basic_rack import DEDENDUM
from flexspline.geometry.design import Design

WRONG_MODULE_RATIO = 1.5
"""Times too large or too small: no ring's thickness mends that."""


def root_radius_mm(design: Design) -> float:
    """Of the tooth roots, by module and teeth."""
    return design.gear.module_mm * (design.gear.teeth_flexspline / 2 - DEDENDUM)


def module_hint(design: Design) -> str:
    """The module that ring and teeth ask for, where the stated one is far from it; else ""."""
    root, ring = root_radius_mm(design), design.flexspline.ring_radius
    if 1 / WRONG_MODULE_RATIO <= root / ring <= WRONG_MODULE_RATIO:
        return ""
    fits = ring / root * design.gear.module_mm
    return (
        f"gear.module_mm = {design.gear.module_mm:g} does not belong to this ring: with "
        f"{design.gear.teeth_flexspline} teeth on a ring of {2 * ring:.4g} mm it is {fits:.2g}"
    )
