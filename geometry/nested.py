"""Two bodies of revolution around a flexspline with bolt holes: one lies inside it, it lies inside the other.

The whole body has no holes. The cut body has lost the annulus that the holes lie in, from bolt_circle/2 −
hole/2 to bolt_circle/2 + hole/2, right through the boss or the flange, and with it what lies beyond: of a
cup the ring around the bore, of a hat the flange's rim. That rest hangs on the mounted face alone, which
holds it, so it is neither turned nor loaded. What is left is a cup with a larger bore, a hat with
a smaller flange. Patches nest as the bodies do: `mesh` and `seat` are the same three times, `mount` is
what each body has of the whole body's mounted face.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Shaft


@dataclass(frozen=True)
class NestedBodies:
    """`cut` ⊂ the part with its holes ⊂ `whole`."""

    cut: Part
    whole: Part


def nested_bodies(part: Part) -> NestedBodies:
    """Of a flexspline with bolt holes.

    Examples
    --------
    Holes of 2.5 mm on a circle of 13 mm: the cut cup has a bore of 15.5 mm.

    >>> from flexspline import load_design
    >>> nested_bodies(load_design("examples/xb1-40.toml").part("flexspline")).cut.shape.bore_diameter_mm
    15.5
    """
    shape, bolts = part.shape, part.bolts
    if bolts is None or isinstance(shape, Shaft):
        raise ValueError("only a flexspline with bolt holes lies between two bodies of revolution")
    if shape.inward:
        edge = {shape.land.inner: 2 * (bolts.radius + bolts.hole_radius)}
    else:
        edge = {shape.land.outer: 2 * (bolts.radius - bolts.hole_radius)}
    whole = part.without_holes()
    return NestedBodies(replace(whole, shape=whole.shape.model_copy(update=edge)), whole)
