"""Checks that module and teeth fit the ring; distinguishes a slipped decimal point from a wrong ring."""

from __future__ import annotations

from flexspline.geometry.basic_rack import DEDENDUM
from flexspline.geometry.design import Design

WRONG_MODULE_RATIO = 1.5
"""Times too large or too small: no ring's thickness mends that."""
MM_PER_M = 1000.0
"""The likeliest slip of a length: metres for millimetres."""


def root_radius_mm(design: Design) -> float:
    """Of the tooth roots, by module and teeth."""
    return design.gear.module_mm * (design.gear.teeth_flexspline / 2 - DEDENDUM)


def diameter_in_metres(design: Design) -> tuple[float, float] | None:
    """The inner diameters that module and teeth fit [mm], where that stated is one of them in metres."""
    root, part = root_radius_mm(design), design.flexspline
    ring, inner_mm = part.ring_radius, part.inner_diameter_mm
    if _fits(root, ring) or not _fits(root, ring + (MM_PER_M - 1) * inner_mm / 2):
        return None
    outside = ring - inner_mm / 2
    return 2 * (root / WRONG_MODULE_RATIO - outside), 2 * (root * WRONG_MODULE_RATIO - outside)


def fitting_module_mm(design: Design) -> float:
    """The module whose root circle is the ring's outside."""
    return design.flexspline.ring_radius / root_radius_mm(design) * design.gear.module_mm


def fitting_modules_mm(design: Design) -> tuple[float, float]:
    """The least and the largest that may belong to the ring."""
    middle = fitting_module_mm(design)
    return middle / WRONG_MODULE_RATIO, middle * WRONG_MODULE_RATIO


def module_hint(design: Design) -> str:
    """The module, where it is far from what the rest of the ring asks for; else ""."""
    root, ring = root_radius_mm(design), design.flexspline.ring_radius
    if _fits(root, ring):
        return ""
    return (
        f"gear.module_mm = {design.gear.module_mm:g} does not belong to this ring: with "
        f"{design.gear.teeth_flexspline} teeth on a ring of {2 * ring:.4g} mm it is "
        f"{fitting_module_mm(design):.2g}"
    )


def with_fitting_module(design: Design) -> Design:
    """The design with `fitting_module_mm`, where its own is far from that: what a wrong module says of other
    values is no use."""
    if not module_hint(design):
        return design
    gear = design.gear.model_copy(update={"module_mm": fitting_module_mm(design)})
    return design.model_copy(update={"gear": gear})


def _fits(root_mm: float, ring_mm: float) -> bool:
    return 1 / WRONG_MODULE_RATIO <= root_mm / ring_mm <= WRONG_MODULE_RATIO
