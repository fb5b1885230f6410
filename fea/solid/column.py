"""Where a part with bolt holes is no body of revolution: one column of its meridian.

Around the bolt circle the material fills a rectangle of the (r, z) plane, from a bore or an outer wall
to an `interface` beyond the holes. There the part is its plan, with the holes, extruded in z; all the
rest is its meridian, revolved.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import cos, sin

import numpy as np

from geometry.design import Design
from geometry.meridian import SAME, Meridian, Segment

INTERFACE = "interface"
HOLE = "hole"
SHARE = 0.3
"""How far the interface lies from the holes towards the next feature of the meridian: nearer, and the
plan's triangles beside it are small and many; farther, and the meridian's are."""


@dataclass(frozen=True)
class Column:
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
        return self.depth < self.high - SAME

    def plan(self, sector_rad: float) -> Meridian:
        """Outline in (x, y) between the angles 0 and `sector_rad`, half a hole cut out at 0."""
        rc, rh = self.bolt_circle, self.hole_radius
        c, s = cos(sector_rad), sin(sector_rad)
        corners = [(self.inner, 0.0), (rc - rh, 0.0), (rc, rh), (rc + rh, 0.0), (self.outer, 0.0)]
        corners += [(self.outer * c, self.outer * s), (self.inner * c, self.inner * s)]
        hole, origin = (rc, 0.0), (0.0, 0.0)
        centres = [None, hole, hole, None, origin, None, origin]
        of_arc = {self.outer: "outer", self.inner: "inner"}
        names = [None, HOLE, HOLE, None, "outer", None, "inner"]
        names = [INTERFACE if n == of_arc[self.interface] else n for n in names]
        ends = corners[1:] + corners[:1]
        return Meridian(tuple(map(Segment, corners, ends, centres, names)))

    def rest(self, outline: Meridian) -> Meridian:
        """The outline beyond the interface, closed by segments named INTERFACE."""
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
        z = [kept[-1].end[1], *([self.depth] if self.blind else []), kept[0].start[1]]
        closing = [
            Segment((self.interface, a), (self.interface, b), patch=INTERFACE)
            for a, b in pairwise(z)
        ]
        return Meridian((*kept, *closing))


def column_of(design: Design, part: str, outline: Meridian) -> Column | None:
    """The column around the bolt circle; None where the meridian is no rectangle there."""
    bolts = (design.shaft if part == "shaft" else design.flexspline).bolts
    if bolts is None:
        return None
    circle, hole = float(np.hypot(*bolts.centres[0])), bolts.hole_radius
    r = _radii(outline)
    below, above = float(r[r <= circle - hole].max()), float(r[r >= circle + hole].min())
    if below <= r.min() + SAME < 2 * below:  # a bore, and not the axis
        inner = below
        outer = interface = circle + hole + SHARE * (above - circle - hole)
    elif above >= r.max() - SAME:
        outer = above
        inner = interface = circle - hole - SHARE * (circle - hole - below)
    else:
        return None
    across = [s for s in outline.segments if (s.start[0] - interface) * (s.end[0] - interface) < 0]
    z = sorted(s.start[1] for s in across)
    if len(z) != 2 or any(abs(s.start[1] - s.end[1]) > SAME for s in across):
        return None
    depth = _hole_depth(design, part)
    return Column(inner, outer, interface, z[0], z[1], min(depth, z[1]), circle, hole)


def _radii(outline: Meridian) -> np.ndarray:
    """Radii of the outline's vertices, and along its arcs."""
    found = [s.at(np.linspace(0, 1, 2 if s.centre is None else 9))[:, 0] for s in outline.segments]
    return np.concatenate(found)


def _hole_depth(design: Design, part: str) -> float:
    """z to which the contract drills: the first segment, the boss or the flange."""
    if part == "shaft":
        return design.shaft.segment[0].length_mm
    f = design.flexspline
    return f.boss_thickness_mm if f.kind == "cup" else f.flange_thickness_mm
