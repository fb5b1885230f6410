"""Ways to sweep a part: about the axis, with holes and a keyway in plain places, or along the axis."""

from __future__ import annotations

from flexspline.fea.solid.column import HoledColumn, column_of
from flexspline.fea.solid.slot import SlottedTube
from flexspline.fea.solid.slot_place import block_of
from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Shaft


def can_be_swept(part: Part) -> bool:
    """Whether a sweep is tried: about the axis, or, of shafts, along it."""
    return goes_about_axis(part) or isinstance(part.shape, Shaft)


def goes_about_axis(part: Part) -> bool:
    """Whether the part is a body of revolution, or one with holes in a plain column and a plain keyway."""
    column = column_of(part)
    if part.bolts is not None and column is None:
        return False
    return part.keyway is None or bent_block(part, column) is not None


def half_holes(part: Part, sector_deg: float) -> int:
    """Return how many halves of bolt holes a sector from the middle of the first has; 0 without holes."""
    return 0 if part.bolts is None else round(2 * part.bolts.count * sector_deg / 360)


def bent_block(part: Part, column: HoledColumn | None) -> SlottedTube | None:
    """Return the keyway onto which the mesh is bent, above the holes' column; None where it is not."""
    return block_of(part, 0.0 if column is None else column.high)
