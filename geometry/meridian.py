"""Meridians of the same body with another patch: a narrower seat, a mount that is held in part."""

from __future__ import annotations

import numpy as np

from flexspline.geometry.outline import Meridian, Segment
from flexspline.geometry.profile import pair


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
