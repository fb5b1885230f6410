"""The column of the meridian in which a part with bolt holes is not a body of revolution.

Around the bolt circle the material fills a rectangle of the (r, z) plane, from a bore, the axis or an outer
wall to an `interface` beyond the holes. There the part is its plan, with the holes, extruded in z; all the
rest is its meridian, revolved.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import ceil, cos, pi, sin

import numpy as np

from flexspline.geometry.outline import Meridian, SAME_mm, Segment, distinct
from flexspline.geometry.part import Part

INTERFACE = "interface"
HOLE = "hole"
CORE_RIM = "core_rim"
SHARE = 0.3
"""Where the interface lies, as a share of the distance from the holes to the next feature of the meridian. If
it is nearer, the plan's triangles beside it are small and many; if it is farther, the meridian's are."""
NARROW_OF_RADIUS, NARROW_OF_HEIGHT = 0.1, 0.02
"""A land between the holes and that feature narrower than these shares of the hole's radius and of the
column's height is left to the mesher: fair triangles in it are too many (30 000 elements on a cup's
land of 0.05 mm, 400 000 on one of 0.005)."""
LARGEST_ARC = pi / 2
"""[rad] Of an outline's arc, which stays clearly below the 180° that `Segment` allows."""
COLUMN_CORE = 0.5
"""Share of the holes' smallest radius at which the plan's triangles end if the column reaches the axis.
Nearer to the axis they would be needles with the sector's angle."""


@dataclass(frozen=True)
class HoledColumn:
    """The column from radius `inner` to `outer` [mm], one of which is the interface.

    Attributes
    ----------
    low, high : its z range [mm]. depth : z where the holes end, at most `high`.
    bolt_circle, hole_radius : [mm]; the first hole is at angle 0.
    """

    inner: float
    outer: float
    interface: float
    low: float
    high: float
    depth: float
    bolt_circle: float
    hole_radius: float

    @property
    def blind(self) -> bool:
        """Whether material closes the holes above."""
        return self.depth < self.high - SAME_mm

    @property
    def core(self) -> float:
        """Radius [mm] within which the plan is a fan about the axis; 0 for a column off the axis."""
        return COLUMN_CORE * (self.bolt_circle - self.hole_radius) if self.inner == 0 else 0.0

    def plan(self, sector_rad: float, arc_rad: float = LARGEST_ARC) -> Meridian:
        """Return the outline in (x, y) between the angles 0 and `sector_rad`, half a hole cut out at 0.

        No arc about the axis is longer than `arc_rad`.

        Its inner end is named CORE_RIM where the core lies within it.
        """
        rc, rh = self.bolt_circle, self.hole_radius
        turns = np.linspace(0, sector_rad, ceil(sector_rad / min(arc_rad, LARGEST_ARC)) + 1)
        outer = [(self.outer * cos(a), self.outer * sin(a)) for a in turns]
        within = self.inner or self.core
        inner = [(within * cos(a), within * sin(a)) for a in turns[::-1]]
        hole, origin = (rc, 0.0), (0.0, 0.0)
        outside = self.interface == self.outer
        inside = INTERFACE if not outside else CORE_RIM if self.core else None
        segments = [
            Segment(inner[-1], (rc - rh, 0.0)),
            Segment((rc - rh, 0.0), (rc, rh), hole, HOLE),
            Segment((rc, rh), (rc + rh, 0.0), hole, HOLE),
            Segment((rc + rh, 0.0), outer[0]),
            *(Segment(a, b, origin, INTERFACE if outside else None) for a, b in pairwise(outer)),
            Segment(outer[-1], inner[0]),
            *(Segment(a, b, origin, inside) for a, b in pairwise(inner)),
        ]
        return Meridian(tuple(segments))

    def rest(self, outline: Meridian) -> Meridian:
        """Return the outline beyond the interface, closed by segments named INTERFACE."""
        outside = self.interface == self.outer

        def beyond(r: float) -> bool:
            return r > self.interface if outside else r < self.interface

        kept: list[Segment] = []
        gap = 0
        for s in outline.segments:
            if beyond(s.start[0]) and beyond(s.end[0]):
                kept.append(s)
            elif beyond(s.start[0]):
                kept.append(Segment(s.start, (self.interface, s.start[1]), patch=s.patch))
                gap = len(kept)
            elif beyond(s.end[0]):
                kept.append(Segment((self.interface, s.end[1]), s.end, patch=s.patch))
        kept = kept[gap:] + kept[:gap]
        z = self._levels(outline)
        if kept[-1].end[1] > kept[0].start[1]:
            z = z[::-1]
        closing = [
            Segment((self.interface, a), (self.interface, b), patch=INTERFACE)
            for a, b in pairwise(z)
        ]
        return Meridian((*kept, *closing))

    def _levels(self, outline: Meridian) -> list[float]:
        """z from low to high where the column's surface changes: nodes of the interface, thus of it all.

        Vertices of its free wall, and the holes' end.
        """
        wall = self.inner if self.interface == self.outer else self.outer
        inside = [s.start[1] for s in outline.segments if abs(s.start[0] - wall) < SAME_mm]
        levels = self.low, *inside, self.depth, self.high
        return distinct(z for z in levels if self.low <= z <= self.high)


def column_of(part: Part) -> HoledColumn | None:
    """Return the column around the bolt circle; None where the meridian is no plain rectangle there.

    That is where a step or an arc of it lies over the holes, where it has steps to both sides of them,
    or where their land is too narrow.
    """
    outline, bolts = part.meridian, part.bolts
    if bolts is None:
        return None
    circle, hole = float(np.hypot(*bolts.centres[0])), bolts.hole_radius
    r = _radii(outline)
    within, beyond = r[r <= circle - hole], r[r >= circle + hole]
    if len(within) + len(beyond) < len(r) or not len(within) or not len(beyond):
        return None  # something changes over the holes, or one of them lies over the axis
    below, above = float(within.max()), float(beyond.min())
    if below <= r.min() + SAME_mm:
        land = above - circle - hole
        inner, outer = below, circle + hole + SHARE * land
        interface = outer
    elif above >= r.max() - SAME_mm:
        land = circle - hole - below
        inner, outer = circle - hole - SHARE * land, above
        interface = inner
    else:
        return None
    across = [s for s in outline.segments if (s.start[0] - interface) * (s.end[0] - interface) < 0]
    z = sorted(s.start[1] for s in across)
    if len(z) != 2 or any(abs(s.start[1] - s.end[1]) > SAME_mm for s in across):
        return None
    if land < max(NARROW_OF_RADIUS * hole, NARROW_OF_HEIGHT * (z[1] - z[0])):
        return None
    depth = min(part.hole_depth, z[1])
    return HoledColumn(inner, outer, interface, z[0], z[1], depth, circle, hole)


def _radii(outline: Meridian) -> np.ndarray:
    """Radii of the outline's vertices, and along its arcs."""
    radii = [s.at(np.linspace(0, 1, 2 if s.centre is None else 9))[:, 0] for s in outline.segments]
    return np.concatenate(radii)
