"""A closed outline from its corners: those with a fillet rounded, edges named for their patches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import acos, tan

import numpy as np

from flexspline.geometry.outline import Meridian, Point, SAME_mm, Segment, distance


@dataclass(frozen=True)
class Corner:
    """Of a profile: place (r, z) [mm], patch of the edge that leads to it, and radius of its fillet [mm]."""

    at: Point
    patch: str | None = None
    fillet: float = 0.0


def closed(corners: Sequence[Corner], cuts: Sequence[Segment]) -> Meridian:
    """Round the corners that ask for it and join them to a closed outline."""
    kept = [c for i, c in enumerate(corners) if distance(c.at, corners[i - 1].at) > SAME_mm]
    around = zip([kept[-1], *kept], kept, [*kept[1:], kept[0]], strict=False)
    fillets = [_fillet(before.at, c, after.at) for before, c, after in around]
    segments: list[Segment] = []
    for before, c, fillet in zip([fillets[-1], *fillets], kept, fillets, strict=False):
        if distance(before.end, fillet.start) > SAME_mm:
            segments.append(Segment(before.end, fillet.start, patch=c.patch))
        if fillet.centre is not None:
            segments.append(fillet)
    return Meridian(tuple(segments), tuple(cuts))


def _fillet(before: Point, corner: Corner, after: Point) -> Segment:
    """The arc that rounds a corner between its neighbours; of a sharp one the corner alone, no arc."""
    if corner.fillet <= 0:
        return Segment(corner.at, corner.at)
    p = np.array(corner.at)
    u, v = np.array(before) - p, np.array(after) - p
    u /= np.linalg.norm(u)
    v /= np.linalg.norm(v)
    half = acos(float(np.clip(u @ v, -1, 1))) / 2
    trim = corner.fillet / tan(half)
    centre = p + (u + v) / np.linalg.norm(u + v) * corner.fillet / np.sin(half)
    return Segment(pair(p + trim * u), pair(p + trim * v), pair(centre))


def pair(p: np.ndarray) -> Point:
    """A point of plain numbers."""
    return float(p[0]), float(p[1])
