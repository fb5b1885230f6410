"""Checks whether a swept mesh of a shaft can be moved onto its keyway, and over which length."""

from __future__ import annotations

from math import hypot

from flexspline.fea.solid.slot import SlottedTube
from flexspline.geometry.outline import SAME_mm
from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Shaft

LEAST_RIM = 0.1
"""Least material between the floor's corner and the outer wall, as a share of the slot's depth. The block's
elements there are as thin as it; shafts with less are left to the mesher."""
FADING = 1.0
"""Length over which the bending fades out, over the largest change of a radius: a slope of 45° in the
mesh."""
LEAST_FADING = 0.5
"""Least share of that length that a step of the shaft may leave. With less, elements would be bent too far.
Judgement."""


def block_of(part: Part, low: float) -> SlottedTube | None:
    """Return the shaft's keyway, if the mesh can be bent onto it; nothing below `low` [mm] is bent.

    None without a keyway, where the slot leaves the last segment, reaches too near its outer wall, or
    begins too near a step.
    """
    cut, shape = part.keyway, part.shape
    if cut is None or not isinstance(shape, Shaft):
        return None
    last = shape.segment[-1]
    outer, inner = last.outer_diameter_mm / 2, last.inner_diameter_mm / 2
    base = shape.length - last.length_mm
    narrowing = len(shape.segment) > 1 and (
        shape.segment[-2].outer_diameter_mm < last.outer_diameter_mm
        or shape.segment[-2].inner_diameter_mm != last.inner_diameter_mm
    )
    wide = base
    if len(shape.segment) > 1 and not narrowing:  # the bending may go on into the segment before
        wide -= shape.segment[-2].length_mm
    room = cut.start - max(low, wide)
    corner = hypot(cut.floor, cut.half_width)
    wanted = FADING * (corner - cut.floor + cut.half_width)
    fading = min(wanted, room)
    if (
        cut.start < base + SAME_mm
        or outer - corner < LEAST_RIM * (outer - cut.floor)
        or fading < LEAST_FADING * wanted
    ):
        return None
    return SlottedTube(cut, inner, outer, fading)
