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
    entry: list[Point] = []
    leave: list[Point] = []
    arcs: list[Segment | None] = []
    for i, c in enumerate(kept):
        if c.fillet <= 0:
            entry.append(c.at)
            leave.append(c.at)
            arcs.append(None)
            continue
        p = np.array(c.at)
        u = np.array(kept[i - 1].at) - p
        v = np.array(kept[(i + 1) % len(kept)].at) - p
        u /= np.linalg.norm(u)
        v /= np.linalg.norm(v)
        half = acos(float(np.clip(u @ v, -1, 1))) / 2
        trim = c.fillet / tan(half)
        centre = p + (u + v) / np.linalg.norm(u + v) * c.fillet / np.sin(half)
        a, b = pair(p + trim * u), pair(p + trim * v)
        entry.append(a)
        leave.append(b)
        arcs.append(Segment(a, b, pair(centre)))
    segments: list[Segment] = []
    for i, c in enumerate(kept):
        if distance(leave[i - 1], entry[i]) > SAME_mm:
            segments.append(Segment(leave[i - 1], entry[i], patch=c.patch))
        arc = arcs[i]
        if arc is not None:
            segments.append(arc)
    return Meridian(tuple(segments), tuple(cuts))


def pair(p: np.ndarray) -> Point:
    """A point of plain numbers."""
    return float(p[0]), float(p[1])
