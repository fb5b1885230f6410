"""The meridian of each part: its outline in the (r, z) half plane, corners rounded, patches named.

Written once; the CAD solid revolves it, the axisymmetric solver meshes it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import acos, tan
from typing import Any

import numpy as np

from flexspline.geometry.outline import Meridian, Point, SAME_mm, Segment, distance
from flexspline.geometry.shaft_shape import Shaft
from flexspline.geometry.shapes import Cup, Flexspline, Hat


@dataclass(frozen=True)
class _Corner:
    at: Point
    patch: str | None = None  # of the edge that leads here
    fillet: float = 0.0


def _close(corners: list[_Corner], cuts: list[Segment]) -> Meridian:
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
        a, b = _pair(p + trim * u), _pair(p + trim * v)
        entry.append(a)
        leave.append(b)
        arcs.append(Segment(a, b, _pair(centre)))
    segments: list[Segment] = []
    for i, c in enumerate(kept):
        if distance(leave[i - 1], entry[i]) > SAME_mm:
            segments.append(Segment(leave[i - 1], entry[i], patch=c.patch))
        arc = arcs[i]
        if arc is not None:
            segments.append(arc)
    return Meridian(tuple(segments), tuple(cuts))


def _pair(p: np.ndarray) -> Point:
    return float(p[0]), float(p[1])


def _ring(f: Flexspline) -> list[_Corner]:
    """Up the outside from the tube to the open rim and down the inside to the seat's lower end."""
    ri, rw, rr = f.inner_radius, f.wall_radius, f.ring_radius
    return [
        _Corner((rw, f.ring_start - (rr - rw))),
        _Corner((rr, f.ring_start)),
        _Corner((rr, f.ring_end), "mesh"),
        _Corner((rw, f.ring_end)) if f.ring_offset_mm > 0 else _Corner((rr, f.ring_end)),
        _Corner((rw if f.ring_offset_mm > 0 else rr, f.length_mm)),
        _Corner((ri, f.length_mm)),
        _Corner((ri, f.ring_end)),
        _Corner((ri, f.ring_start), "seat"),
    ]


def _ring_cuts(f: Flexspline) -> list[Segment]:
    ri, rr = f.inner_radius, f.ring_radius
    cuts = [Segment((ri, f.ring_start), (rr, f.ring_start))]
    if f.ring_offset_mm > 0:
        cuts.append(Segment((ri, f.ring_end), (f.wall_radius, f.ring_end)))
    return cuts


def cup_meridian(f: Cup) -> Meridian:
    """The outline of a cup (docs/contract.md)."""
    bore, boss = f.bore_diameter_mm / 2, f.boss_diameter_mm / 2
    h = f.diaphragm_thickness_mm
    corners = [
        _Corner((bore, 0.0)),
        _Corner((boss, 0.0), "mount"),
        _Corner((f.wall_radius, 0.0), fillet=f.outer_fillet_mm),
        *_ring(f),
        _Corner((f.inner_radius, h), fillet=f.inner_fillet_mm),
        _Corner((boss, h)),
        _Corner((boss, f.boss_thickness_mm)),
        _Corner((bore, f.boss_thickness_mm)),
    ]
    return _close(corners, [*_ring_cuts(f), Segment((boss, 0.0), (boss, h))])


def hat_meridian(f: Hat) -> Meridian:
    """The outline of a hat (docs/contract.md)."""
    outer, inner = f.flange_outer_diameter_mm / 2, f.flange_inner_diameter_mm / 2
    h = f.diaphragm_thickness_mm
    corners = [
        _Corner((f.inner_radius, 0.0), fillet=f.outer_fillet_mm),
        _Corner((inner, 0.0)),
        _Corner((outer, 0.0), "mount"),
        _Corner((outer, f.flange_thickness_mm)),
        _Corner((inner, f.flange_thickness_mm)),
        _Corner((inner, h)),
        _Corner((f.wall_radius, h), fillet=f.inner_fillet_mm),
        *_ring(f),
    ]
    return _close(corners, [*_ring_cuts(f), Segment((inner, 0.0), (inner, h))])


def shaft_meridian(s: Shaft) -> Meridian:
    """Segments stacked from z = 0; fillets at every inside corner of the outer diameter."""
    grip_start = s.length - s.grip_length_mm
    outer: list[_Corner] = []
    inner: list[_Corner] = []
    cuts: list[Segment] = []
    z = 0.0
    for i, seg in enumerate(s.segment):
        top = z + seg.length_mm
        if i == len(s.segment) - 1:
            top = s.length  # the same rounding as grip_start's
        r, bore = seg.outer_diameter_mm / 2, seg.inner_diameter_mm / 2
        below = s.segment[i - 1].outer_diameter_mm / 2 if i else 0.0
        above = s.segment[i + 1].outer_diameter_mm / 2 if i + 1 < len(s.segment) else 0.0
        outer.append(_Corner((r, z), fillet=s.fillet_mm if i and below > r + SAME_mm else 0.0))
        if z + SAME_mm < grip_start < top - SAME_mm:
            outer.append(_Corner((r, grip_start)))
            cuts.append(Segment((bore, grip_start), (r, grip_start)))
        patch = "grip" if grip_start < top - SAME_mm else None
        outer.append(_Corner((r, top), patch, s.fillet_mm if above > r + SAME_mm else 0.0))
        inner += [_Corner((bore, z)), _Corner((bore, top))]
        z = top
    first = s.segment[0]
    corners = [
        _Corner((first.inner_diameter_mm / 2, 0.0)),
        _Corner((first.outer_diameter_mm / 2, 0.0), "mount"),
        *outer[1:],
        *inner[:0:-1],
    ]
    return _close(corners, cuts)


_OUTLINES: Mapping[type, Callable[[Any], Meridian]] = {
    Cup: cup_meridian,
    Hat: hat_meridian,
    Shaft: shaft_meridian,
}


def meridian_of(shape: Flexspline | Shaft) -> Meridian:
    """Outline of any part."""
    return _OUTLINES[type(shape)](shape)


def with_narrow_seat(outline: Meridian, share: float) -> Meridian:
    """The same body with a `seat` of that share (below 1) of its width, in the middle of the old one."""
    found: list[Segment] = []
    for s in outline.segments:
        if s.patch != "seat":
            found.append(s)
            continue
        at = s.at(np.array([0.0, (1 - share) / 2, (1 + share) / 2, 1.0]))
        a, b, c, d = (_pair(p) for p in at)
        found += [Segment(a, b), Segment(b, c, patch="seat"), Segment(c, d)]
    return Meridian(tuple(found), outline.cuts)
