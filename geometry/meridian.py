"""The meridian of each part: its outline in the (r, z) half plane, corners rounded, patches named.

Written once; the CAD solid revolves it, the axisymmetric solver meshes it.
"""

from __future__ import annotations

import numpy as np

from flexspline.geometry.outline import Meridian, SAME_mm, Segment
from flexspline.geometry.profile import Corner, closed, pair
from flexspline.geometry.shaft_shape import Shaft
from flexspline.geometry.shapes import Flexspline


def meridian_of(shape: Flexspline | Shaft) -> Meridian:
    """Outline of any part."""
    return shaft_meridian(shape) if isinstance(shape, Shaft) else shape.meridian()


def shaft_meridian(s: Shaft) -> Meridian:
    """Segments stacked from z = 0; fillets at every inside corner of the outer diameter."""
    grip_start = s.length - s.grip_length_mm
    outer: list[Corner] = []
    inner: list[Corner] = []
    cuts: list[Segment] = []
    z = 0.0
    for i, seg in enumerate(s.segment):
        top = z + seg.length_mm
        if i == len(s.segment) - 1:
            top = s.length  # the same rounding as grip_start's
        r, bore = seg.outer_diameter_mm / 2, seg.inner_diameter_mm / 2
        below = s.segment[i - 1].outer_diameter_mm / 2 if i else 0.0
        above = s.segment[i + 1].outer_diameter_mm / 2 if i + 1 < len(s.segment) else 0.0
        outer.append(Corner((r, z), fillet=s.fillet_mm if i and below > r + SAME_mm else 0.0))
        if z + SAME_mm < grip_start < top - SAME_mm:
            outer.append(Corner((r, grip_start)))
            cuts.append(Segment((bore, grip_start), (r, grip_start)))
        patch = "grip" if grip_start < top - SAME_mm else None
        outer.append(Corner((r, top), patch, s.fillet_mm if above > r + SAME_mm else 0.0))
        inner += [Corner((bore, z)), Corner((bore, top))]
        z = top
    first = s.segment[0]
    corners = [
        Corner((first.inner_diameter_mm / 2, 0.0)),
        Corner((first.outer_diameter_mm / 2, 0.0), "mount"),
        *outer[1:],
        *inner[:0:-1],
    ]
    return closed(corners, cuts)


def with_narrow_seat(outline: Meridian, share: float) -> Meridian:
    """The same body with a `seat` of that share (below 1) of its width, in the middle of the old one."""
    segments: list[Segment] = []
    for s in outline.segments:
        if s.patch != "seat":
            segments.append(s)
            continue
        at = s.at(np.array([0.0, (1 - share) / 2, (1 + share) / 2, 1.0]))
        a, b, c, d = (pair(p) for p in at)
        segments += [Segment(a, b), Segment(b, c, patch="seat"), Segment(c, d)]
    return Meridian(tuple(segments), outline.cuts)


def with_mount_from(outline: Meridian, radius_mm: float) -> Meridian:
    """The same body whose `mount`, a flat face, is held only from a radius outwards."""
    segments: list[Segment] = []
    for s in outline.segments:
        if s.patch == "mount" and s.start[0] < radius_mm < s.end[0]:
            edge = (radius_mm, s.start[1])
            segments += [Segment(s.start, edge), Segment(edge, s.end, patch="mount")]
        else:
            segments.append(s)
    return Meridian(tuple(segments), outline.cuts)
