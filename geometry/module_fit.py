"""Checks that module and teeth fit the ring; distinguishes a slipped decimal point from a wrong ring."""

from __future__ import annotations

from flexspline.geometry.basic_rack import DEDENDUM
from flexspline.geometry.design import Design
from flexspline.geometry.ranges import MODULE_mm

WRONG_MODULE_RATIO = 1.5
"""Times too large or too small: no ring's thickness mends that."""
MM_PER_M = 1000.0
"""The likeliest slip of a length: metres for millimetres."""


def root_radius_mm(design: Design) -> float:
    """Of the tooth roots, by module and teeth."""
    return design.gear.module_mm * (design.gear.teeth_flexspline / 2 - DEDENDUM)


def fitting_diameters_mm(design: Design) -> tuple[float, float]:
    """The inner diameters that module and teeth fit."""
    root, part = root_radius_mm(design), design.flexspline
    outside = part.ring_radius - part.inner_radius
    return 2 * (root / WRONG_MODULE_RATIO - outside), 2 * (root * WRONG_MODULE_RATIO - outside)


def looks_like_metres(design: Design) -> bool:
    """Whether the inner diameter stated is one in metres that module and teeth fit."""
    root, part = root_radius_mm(design), design.flexspline
    ring = part.ring_radius
    return not _fits(root, ring) and _fits(root, ring + (MM_PER_M - 1) * part.inner_radius)


def fitting_module_mm(design: Design) -> float:
    """The module whose root circle is the ring's outside."""
    return design.flexspline.ring_radius / root_radius_mm(design) * design.gear.module_mm


def fitting_modules_mm(design: Design) -> tuple[float, float]:
    """The least and the largest that may belong to the ring, within what any module may be."""
    middle = fitting_module_mm(design)
    low, high = middle / WRONG_MODULE_RATIO, middle * WRONG_MODULE_RATIO
    return max(low, MODULE_mm.low), min(high, MODULE_mm.high)


def module_hint(design: Design) -> str:
    """The module, where it is far from what the rest of the ring asks for; else ""."""
    root, ring = root_radius_mm(design), design.flexspline.ring_radius
    if _fits(root, ring):
        return ""
    wanted = fitting_module_mm(design)
    too_small = f", less than any may be ({MODULE_mm.low:g} mm)" if wanted < MODULE_mm.low else ""
    return (
        f"gear.module_mm = {design.gear.module_mm:g} does not belong to this ring: with "
        f"{design.gear.teeth_flexspline} teeth on a ring of {2 * ring:.4g} mm it is {wanted:.2g}{too_small}"
    )


def with_fitting_module(design: Design) -> Design:
    """The design with `fitting_module_mm`, where its own is far from that: what a wrong module says of other
    values is no use. The design itself where no module fits."""
    fitting = fitting_module_mm(design)
    if not module_hint(design) or not MODULE_mm.low <= fitting <= MODULE_mm.high:
        return design
    gear = design.gear.model_copy(update={"module_mm": fitting})
    return design.model_copy(update={"gear": gear})


def _fits(root_mm: float, ring_mm: float) -> bool:
    return 1 / WRONG_MODULE_RATIO <= root_mm / ring_mm <= WRONG_MODULE_RATIO
