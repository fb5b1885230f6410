"""Meridian profiles: closed outlines in the (r, z) half plane, with fillets and named patches.

Written once as plain numbers; the CAD solid revolves them, the axisymmetric solver meshes them.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, atan2, hypot, pi, tan

import numpy as np

from geometry.design import Cup, Design, Hat, Shaft

Point = tuple[float, float]
SAME = 1e-9
"""Points closer than this [mm] are one point."""


@dataclass(frozen=True)
class Segment:
    """A straight line, or a circular arc of less than 180° if `centre` is given.

    `patch` names the surface that the segment sweeps, where the contract names it.
    """

    start: Point
    end: Point
    centre: Point | None = None
    patch: str | None = None

    @property
    def radius(self) -> float:
        """Of the arc [mm]; 0 for a line."""
        return 0.0 if self.centre is None else _distance(self.start, self.centre)

    @property
    def sweep(self) -> float:
        """Signed opening angle of the arc [rad], positive counter-clockwise; 0 for a line."""
        if self.centre is None:
            return 0.0
        a = atan2(self.start[1] - self.centre[1], self.start[0] - self.centre[0])
        b = atan2(self.end[1] - self.centre[1], self.end[0] - self.centre[0])
        return (b - a + pi) % (2 * pi) - pi

    @property
    def length(self) -> float:
        """Arc length [mm]."""
        if self.centre is None:
            return _distance(self.start, self.end)
        return self.radius * abs(self.sweep)

    @property
    def on_axis(self) -> bool:
        return self.start[0] < SAME and self.end[0] < SAME

    def at(self, t: float | np.ndarray) -> np.ndarray:
        """Point(s) (r, z) at parameter t in [0, 1], by arc length; shape (..., 2)."""
        s = np.asarray(t, float)[..., None]
        start, end = np.array(self.start), np.array(self.end)
        if self.centre is None:
            return start + s * (end - start)
        c = np.array(self.centre)
        a0 = atan2(*(start - c)[::-1])
        angle = a0 + s[..., 0] * self.sweep
        return c + self.radius * np.stack([np.cos(angle), np.sin(angle)], -1)

    def tangent(self, t: float) -> np.ndarray:
        """Unit tangent at t (0 or 1), shape (2,)."""
        if self.centre is None:
            d = np.array(self.end) - np.array(self.start)
            return d / np.linalg.norm(d)
        d = self.at(t) - np.array(self.centre)
        turned = np.array([-d[1], d[0]]) * np.sign(self.sweep)
        return turned / np.linalg.norm(turned)

    def nearest(self, rz: np.ndarray) -> np.ndarray:
        """Nearest points of the segment (ends included) to points of shape (n, 2)."""
        start, end = np.array(self.start), np.array(self.end)
        if self.centre is None:
            d = end - start
            t = np.clip((rz - start) @ d / (d @ d), 0.0, 1.0)
            return start + t[:, None] * d
        c = np.array(self.centre)
        a0 = atan2(*(start - c)[::-1])
        middle = a0 + self.sweep / 2
        v = rz - c
        off = (np.arctan2(v[:, 1], v[:, 0]) - middle + pi) % (2 * pi) - pi
        half = abs(self.sweep) / 2
        angle = middle + np.clip(off, -half, half)
        return c + self.radius * np.stack([np.cos(angle), np.sin(angle)], -1)

    @property
    def swept_area(self) -> float:
        """Area of the full surface of revolution, 2π ∫ r ds [mm²] (Pappus)."""
        if self.centre is None:
            return pi * (self.start[0] + self.end[0]) * self.length
        # ∫ r ds over an arc: rc·R|φ| + R·|z difference|, with the sign of the turning
        rise = (self.end[1] - self.start[1]) * np.sign(self.sweep)
        return 2 * pi * (self.centre[0] * self.length + self.radius * rise)

    @property
    def swept_volume(self) -> float:
        """π ∫ r² dz along the segment [mm³]: its signed share of the solid's volume (Pappus)."""
        (r0, z0), (r1, z1) = self.start, self.end
        if self.centre is None:
            return pi * (z1 - z0) * (r0 * r0 + r0 * r1 + r1 * r1) / 3
        x, w = np.polynomial.legendre.leggauss(24)  # exact to rounding for an arc below 180°
        angle0 = atan2(z0 - self.centre[1], r0 - self.centre[0])
        a = angle0 + self.sweep * (x + 1) / 2
        r = self.centre[0] + self.radius * np.cos(a)
        return float(pi * np.sum(w * r * r * self.radius * np.cos(a)) * self.sweep / 2)


@dataclass(frozen=True)
class Meridian:
    """A closed, counter-clockwise outline; `cuts` run across the material at patch edges."""

    segments: tuple[Segment, ...]
    cuts: tuple[Segment, ...] = ()

    @property
    def volume(self) -> float:
        """Of the body of revolution [mm³], by Pappus' theorem."""
        return sum(s.swept_volume for s in self.segments)

    def patch_area(self, patch: str) -> float:
        """Of the body of revolution's patch [mm²]; 0 if there is none of that name."""
        return sum(s.swept_area for s in self.segments if s.patch == patch)

    @property
    def sharp_corners(self) -> tuple[Point, ...]:
        """Corners (r, z) off the axis where the outline's tangent turns."""
        found = []
        for i, s in enumerate(self.segments):
            before = self.segments[i - 1]
            if s.start[0] > SAME and before.tangent(1) @ s.tangent(0) < 1 - 1e-6:
                found.append(s.start)
        return tuple(found)

    @property
    def patch_edges(self) -> tuple[Point, ...]:
        """Points (r, z) where the patch name changes along the outline."""
        return tuple(
            s.start
            for i, s in enumerate(self.segments)
            if s.patch != self.segments[i - 1].patch and s.start[0] > SAME
        )

    def polygon(self, chord_error: float) -> np.ndarray:
        """Vertices (n, 2) of the outline, arcs as chords no farther off than chord_error [mm]."""
        points = [s.at(np.arange(n) / n) for s in self.segments for n in [_chords(s, chord_error)]]
        return np.concatenate(points)


def _chords(s: Segment, chord_error: float) -> int:
    if s.centre is None:
        return 1
    largest = 2 * acos(max(0.0, 1 - chord_error / s.radius))
    return max(2, int(np.ceil(abs(s.sweep) / largest)))


def _distance(a: Point, b: Point) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])


@dataclass(frozen=True)
class _Corner:
    at: Point
    patch: str | None = None  # of the edge that leads here
    fillet: float = 0.0


def _close(corners: list[_Corner], cuts: list[Segment]) -> Meridian:
    """Round the corners that ask for it and join them to a closed outline."""
    kept = [c for i, c in enumerate(corners) if _distance(c.at, corners[i - 1].at) > SAME]
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
        if _distance(leave[i - 1], entry[i]) > SAME:
            segments.append(Segment(leave[i - 1], entry[i], patch=c.patch))
        arc = arcs[i]
        if arc is not None:
            segments.append(arc)
    return Meridian(tuple(segments), tuple(cuts))


def _pair(p: np.ndarray) -> Point:
    return float(p[0]), float(p[1])


def _ring(f: Cup | Hat) -> list[_Corner]:
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


def _ring_cuts(f: Cup | Hat) -> list[Segment]:
    ri, rr = f.inner_radius, f.ring_radius
    cuts = [Segment((ri, f.ring_start), (rr, f.ring_start))]
    if f.ring_offset_mm > 0:
        cuts.append(Segment((ri, f.ring_end), (f.wall_radius, f.ring_end)))
    return cuts


def cup_meridian(f: Cup) -> Meridian:
    """The contract's outline of a cup."""
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
    """The contract's outline of a hat."""
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
        outer.append(_Corner((r, z), fillet=s.fillet_mm if i and below > r + SAME else 0.0))
        if z + SAME < grip_start < top - SAME:
            outer.append(_Corner((r, grip_start)))
            cuts.append(Segment((bore, grip_start), (r, grip_start)))
        patch = "grip" if grip_start < top - SAME else None
        outer.append(_Corner((r, top), patch, s.fillet_mm if above > r + SAME else 0.0))
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


def meridian(design: Design, part: str) -> Meridian:
    """Outline of ``"flexspline"`` or ``"shaft"``."""
    if part == "shaft":
        return shaft_meridian(design.shaft)
    f = design.flexspline
    return cup_meridian(f) if isinstance(f, Cup) else hat_meridian(f)
