"""Two simpler bodies that enclose a part: one lies inside it, the other around it.

Around a flexspline with bolt holes, bodies of revolution. The whole body has no holes. The cut body has
lost the annulus that the holes lie in, from bolt_circle/2 − hole/2 to bolt_circle/2 + hole/2, right
through the boss or the flange, and with it what lies beyond: of a cup the ring around the bore, of a hat
the flange's rim. That rest hangs on the mounted face alone, which holds it, so it is neither turned nor
loaded. What is left is a cup with a larger bore, a hat with a smaller flange. Patches nest as the bodies
do: `mesh` and `seat` are the same three times, `mount` is what each body has of the whole body's mounted
face.

Around a shaft with fillets, shafts without: the cut one has sharp corners, in the whole one every step is
moved by the fillet's radius over the thinner segment.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf

from flexspline.geometry.outline import SAME_mm
from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Shaft, ShaftSegment


@dataclass(frozen=True)
class NestedBodies:
    """`cut` ⊂ the part ⊂ `whole`."""

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
        edge = {shape.land.inner: 2 * bolts.outer}
    else:
        edge = {shape.land.outer: 2 * bolts.inner}
    whole = part.without_holes()
    return NestedBodies(replace(whole, shape=whole.shape.model_copy(update=edge)), whole)


def has_unfilleted_bodies(part: Part) -> bool:
    """Whether a shaft lies between two without fillets: it has some, and no moved step reaches the grip."""
    shape = part.shape
    if not isinstance(shape, Shaft) or shape.fillet_mm <= SAME_mm or len(shape.segment) == 1:
        return False
    *_, before, last = shape.segment
    thinner = last.outer_diameter_mm < before.outer_diameter_mm - SAME_mm
    free = last.length_mm - (shape.fillet_mm if thinner else 0.0)
    return (
        shape.grip_length_mm <= free - SAME_mm
        and shape.segment[0].length_mm > shape.fillet_mm + SAME_mm
    )


def unfilleted_bodies(part: Part) -> NestedBodies:
    """Of a shaft that `has_unfilleted_bodies`.

    What a step is moved over has no bolt holes, so holes that reach under it end where they did.
    """
    shape = part.shape
    if not isinstance(shape, Shaft):
        raise ValueError("only a shaft lies between two without fillets")
    sharp = shape.model_copy(update={"fillet_mm": 0.0})
    moved = sharp.model_copy(update={"segment": _moved_steps(part, shape)})
    return NestedBodies(replace(part, shape=sharp), replace(part, shape=moved))


def _moved_steps(part: Part, shape: Shaft) -> tuple[ShaftSegment, ...]:
    pieces: list[ShaftSegment] = []
    outer = [0.0, *(s.outer_diameter_mm for s in shape.segment), 0.0]
    for before, segment, after in zip(outer, shape.segment, outer[2:], strict=False):
        size = segment.outer_diameter_mm
        low, high = (shape.fillet_mm if o > size + SAME_mm else 0.0 for o in (before, after))
        for length, diameter in (
            (low, before),
            (segment.length_mm - low - high, size),
            (high, after),
        ):
            if length > SAME_mm:
                piece = {"length_mm": length, "outer_diameter_mm": diameter}
                pieces.append(segment.model_copy(update=piece))
    if part.bolts is None:
        return _joined(pieces, inf)
    return _joined(pieces, 1 if _holes_may_deepen(part, shape) else 0)


def _holes_may_deepen(part: Part, shape: Shaft) -> bool:
    """Whether holes may go through the flange's moved step too: nothing of the part is over them."""
    assert part.bolts is not None
    flange, above = shape.segment[:2]
    if above.outer_diameter_mm > flange.outer_diameter_mm - SAME_mm:
        return False
    beside = above.outer_diameter_mm / 2 + shape.fillet_mm
    return part.bolts.inner >= beside


def _joined(pieces: list[ShaftSegment], to_first: float) -> tuple[ShaftSegment, ...]:
    """Neighbours of the same section as one; so many join the first, in which the holes are."""
    joined = pieces[:1]
    for number, (before, piece) in enumerate(pairwise(pieces)):
        same = (
            abs(before.outer_diameter_mm - piece.outer_diameter_mm) <= SAME_mm
            and abs(before.inner_diameter_mm - piece.inner_diameter_mm) <= SAME_mm
        )
        if same and (len(joined) > 1 or number < to_first):
            length = joined[-1].length_mm + piece.length_mm
            joined[-1] = joined[-1].model_copy(update={"length_mm": length})
        else:
            joined.append(piece)
    return tuple(joined)
