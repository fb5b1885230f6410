"""Lines and circular arcs of a plan, and their intersections."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np

from flexspline.geometry.bolts import BoltCircle
from flexspline.geometry.outline import SAME_mm, SAME_rad

SMALLEST_PIECE = 1e-6
"""Crossings that are nearer to each other than this share of the line's range are one: rounding."""
HOLE_STEP = np.radians(22.5)
"""[rad] Largest edge about a hole's axis at first: 16 edges around it. Elements there are then halved as the
grading requires."""


@dataclass(frozen=True)
class Line:
    """A straight line from `start` to `end` (x, y) [mm]."""

    start: tuple[float, float]
    end: tuple[float, float]
    largest_share: float = 1.0

    def at(self, t: np.ndarray) -> np.ndarray:
        """Points (n, 2) at parameters (n,) from 0 to 1."""
        a, b = np.array(self.start), np.array(self.end)
        return a + np.asarray(t)[:, None] * (b - a)

    def share(self, point: np.ndarray) -> float:
        """Parameter of a point on the line."""
        a, b = np.array(self.start), np.array(self.end)
        return float((point - a) @ (b - a) / ((b - a) @ (b - a)))


@dataclass(frozen=True)
class Arc:
    """A circle's part about `centre` [mm], counter-clockwise from angle `begin` by `sweep` [rad].

    `largest_share` of it is a mesh edge at most.
    """

    centre: tuple[float, float]
    radius: float
    begin: float
    sweep: float
    largest_share: float = 1.0

    def at(self, t: np.ndarray) -> np.ndarray:
        """Points (n, 2) at parameters (n,) from 0 to 1."""
        a = self.begin + np.asarray(t) * self.sweep
        return np.array(self.centre) + self.radius * np.column_stack([np.cos(a), np.sin(a)])

    def share(self, point: np.ndarray) -> float:
        """Parameter of a point on the circle; outside of the part it is below 0 or above 1."""
        off = point - np.array(self.centre)
        turn = (np.arctan2(off[1], off[0]) - self.begin) % (2 * np.pi)
        if turn > (self.sweep + 2 * np.pi) / 2:  # nearer to the beginning than to the end
            turn -= 2 * np.pi
        return float(turn / self.sweep)


Curve = Line | Arc


def hole_arcs(bolts: BoltCircle, sector: float) -> list[Curve]:
    """Return the bolt holes in a sector [rad]: half a hole at angle 0 and at its end, whole ones between."""
    arcs: list[Curve] = []
    for x, y in bolts.centres:
        angle = float(np.arctan2(y, x)) % (2 * np.pi)
        if angle > sector + SAME_rad:
            continue
        start, sweep = angle, 2 * np.pi
        if angle < SAME_rad:
            start, sweep = 0.0, np.pi
        elif angle > sector - SAME_rad:
            start, sweep = angle - np.pi, np.pi
        half = sweep / 2  # two arcs: a circle's parameter has one beginning
        for k in (0, 1):
            arcs.append(Arc((x, y), bolts.hole_radius, start + k * half, half, HOLE_STEP / half))
    return arcs


def crossings(a: Curve, b: Curve) -> Iterator[np.ndarray]:
    """Return the points (2,) where two lines cross, whether or not within their ranges."""
    if isinstance(a, Line) and isinstance(b, Line):
        p, d = np.array(a.start), np.subtract(a.end, a.start)
        q, e = np.array(b.start), np.subtract(b.end, b.start)
        across = d[0] * e[1] - d[1] * e[0]
        if abs(across) > SAME_rad * np.hypot(*d) * np.hypot(*e):
            w = q - p
            yield p + (w[0] * e[1] - w[1] * e[0]) / across * d
    elif isinstance(a, Arc) and isinstance(b, Arc):
        between = np.subtract(b.centre, a.centre)
        away = np.hypot(*between)
        if away > SAME_mm:
            along = (away**2 + a.radius**2 - b.radius**2) / (2 * away)
            yield from _both_sides(np.array(a.centre), between / away, along, a.radius)
    else:
        arc, line = (a, b) if isinstance(a, Arc) else (b, a)
        assert isinstance(arc, Arc)
        assert isinstance(line, Line)
        d = np.subtract(line.end, line.start)
        normal = np.array([d[1], -d[0]]) / np.hypot(*d)
        along = float(np.subtract(line.start, arc.centre) @ normal)
        yield from _both_sides(np.array(arc.centre), normal, along, arc.radius)


def _both_sides(
    centre: np.ndarray, unit: np.ndarray, along: float, radius: float
) -> Iterator[np.ndarray]:
    """Points of a circle whose distance along `unit` from its centre is `along`."""
    if abs(along) < radius:
        half = np.sqrt(radius**2 - along**2)
        for side in (half, -half):
            yield centre + along * unit + side * np.array([-unit[1], unit[0]])


def pieces(curves: Sequence[Curve]) -> list[tuple[int, np.ndarray]]:
    """Return the parameters of each curve, rising from 0 to 1, at its ends and where others cross it."""
    cuts: list[list[float]] = [[0.0, 1.0] for _ in curves]
    for (i, a), (j, b) in combinations(enumerate(curves), 2):
        for point in crossings(a, b):
            s, t = a.share(point), b.share(point)
            if all(-SMALLEST_PIECE < x < 1 + SMALLEST_PIECE for x in (s, t)):
                cuts[i].append(s)
                cuts[j].append(t)
    return [(i, _distinct(shares)) for i, shares in enumerate(cuts)]


def _distinct(shares: list[float]) -> np.ndarray:
    rising = np.sort(np.clip(shares, 0.0, 1.0))
    kept = [0.0, *(b for a, b in pairwise(rising) if b - a > SMALLEST_PIECE)]
    kept[-1] = 1.0 if kept[-1] > 1 - SMALLEST_PIECE else kept[-1]
    return np.array(kept)
