"""Closed outlines in a plane: straight and round segments, named patches, areas and chords.

Plain numbers: the CAD solid revolves or extrudes them, the axisymmetric solver meshes them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import acos, atan2, hypot, pi

import numpy as np

Point = tuple[float, float]
SAME_mm = 1e-9
"""Points closer than this [mm] are one point."""
SAME_rad = 1e-9
"""Directions and angles closer than this are one: 1e-6 mm apart on the largest part."""
ARC_RULE = np.polynomial.legendre.leggauss(24)
"""Gauss's points and weights, exact to rounding for what is swept by an arc below 180°."""
SMOOTH_rad = 0.02
"""Where tangents, or the normals of faces, turn by less [rad], there is no corner: 1.1°, more than rounding
and a CAD kernel's tolerance, and far below the 45° of the flattest corner that a part has."""


@dataclass(frozen=True)
class Segment:
    """A straight line, or a circular arc of less than 180° if `centre` is given.

    `patch` names the surface that the segment sweeps, where docs/contract.md names it.
    """

    start: Point
    end: Point
    centre: Point | None = None
    patch: str | None = None

    @property
    def radius(self) -> float:
        """Of the arc [mm]; 0 for a line."""
        return 0.0 if self.centre is None else distance(self.start, self.centre)

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
            return distance(self.start, self.end)
        return self.radius * abs(self.sweep)

    @property
    def on_axis(self) -> bool:
        return self.start[0] < SAME_mm and self.end[0] < SAME_mm

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
        turn = (np.arctan2(v[:, 1], v[:, 0]) - middle + pi) % (2 * pi) - pi
        half = abs(self.sweep) / 2
        angle = middle + np.clip(turn, -half, half)
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
        x, w = ARC_RULE
        angle0 = atan2(z0 - self.centre[1], r0 - self.centre[0])
        a = angle0 + self.sweep * (x + 1) / 2
        r = self.centre[0] + self.radius * np.cos(a)
        return float(pi * np.sum(w * r * r * self.radius * np.cos(a)) * self.sweep / 2)


@dataclass(frozen=True)
class Meridian:
    """A closed, counter-clockwise outline; `cuts` run across the material at patch edges."""

    segments: tuple[Segment, ...]
    cuts: tuple[Segment, ...] = ()

    def cuts_within(self, reach: float) -> tuple[Segment, ...]:
        """The cuts as far as `reach` [mm] from the patch edges that they start from."""
        cuts: list[Segment] = []
        for cut in self.cuts:
            first, last = (
                any(distance(end, p) < SAME_mm for p in self.patch_edges)
                for end in (cut.start, cut.end)
            )
            if not (first or last) or reach * (first + last) >= cut.length:
                cuts.append(cut)
                continue
            (r1, z1), (r2, z2) = cut.at(np.array([reach, cut.length - reach]) / cut.length)
            if first:
                cuts.append(Segment(cut.start, (float(r1), float(z1))))
            if last:
                cuts.append(Segment((float(r2), float(z2)), cut.end))
        return tuple(cuts)

    @property
    def volume(self) -> float:
        """Of the body of revolution [mm³], by Pappus' theorem."""
        return sum(s.swept_volume for s in self.segments)

    def patch_area(self, patch: str) -> float:
        """Of the body of revolution's patch [mm²]; 0 if there is none of that name."""
        return sum(s.swept_area for s in self.segments if s.patch == patch)

    @property
    def turns(self) -> tuple[tuple[Point, float], ...]:
        """Where each segment starts, (r, z), and how far the tangent turns there [rad]: see `turn`."""
        return tuple((s.start, turn(self.segments[i - 1], s)) for i, s in enumerate(self.segments))

    @property
    def sharp_corners(self) -> tuple[Point, ...]:
        """Corners (r, z) off the axis where the outline's tangent turns."""
        return tuple(at for at, by in self.turns if at[0] > SAME_mm and abs(by) >= SMOOTH_rad)

    @property
    def inside_corners(self) -> tuple[Point, ...]:
        """The sharp corners (r, z) that open less than 180° outside the material."""
        return tuple(at for at, by in self.turns if at[0] > SAME_mm and by <= -SMOOTH_rad)

    @property
    def patch_edges(self) -> tuple[Point, ...]:
        """Points (r, z) where the patch name changes along the outline."""
        return tuple(
            s.start
            for i, s in enumerate(self.segments)
            if s.patch != self.segments[i - 1].patch and s.start[0] > SAME_mm
        )

    def polygon(self, chord_error: float) -> np.ndarray:
        """Vertices (n, 2) of the outline, arcs as chords no farther off than chord_error [mm]."""
        points = [s.at(np.arange(n) / n) for s in self.segments for n in [_chords(s, chord_error)]]
        return np.concatenate(points)


def turn(before: Segment, after: Segment) -> float:
    """How far the tangent turns where `after` starts at the end of `before` [rad], counter-clockwise.

    In a counter-clockwise outline it is negative at inside corners.
    """
    (r0, z0), (r1, z1) = before.tangent(1), after.tangent(0)
    return atan2(r0 * z1 - z0 * r1, r0 * r1 + z0 * z1)


def joins_smoothly(before: Segment, after: Segment) -> bool:
    """Whether `after` goes on where `before` ends, in its direction."""
    return distance(before.end, after.start) < SAME_mm and abs(turn(before, after)) < SMOOTH_rad


def closed(corners: Sequence[tuple[Point, str | None]]) -> Meridian:
    """Straight segments from corner to corner and back to the first, each with its patch."""
    ends = [point for point, _ in (*corners[1:], corners[0])]
    return Meridian(
        tuple(
            Segment(point, end, patch=patch)
            for (point, patch), end in zip(corners, ends, strict=True)
        )
    )


def _chords(s: Segment, chord_error: float) -> int:
    if s.centre is None:
        return 1
    largest = 2 * acos(max(0.0, 1 - chord_error / s.radius))
    return max(2, int(np.ceil(abs(s.sweep) / largest)))


def distance(a: Point, b: Point) -> float:
    """Between two points."""
    return hypot(a[0] - b[0], a[1] - b[1])


def distinct(values: Iterable[float]) -> list[float]:
    """Return lengths [mm], rising, without those within SAME_mm of the one before."""
    kept: list[float] = []
    for value in sorted(values):
        if not kept or value > kept[-1] + SAME_mm:
            kept.append(value)
    return kept
