"""A keyway in a swept shaft: prisms of the slot are removed, and the mesh is moved onto its walls.

In the mesh the slot is a block of prisms: radii beyond that of the floor's corners, z beyond the slot's end,
angles up to one of the mesh's own. Angles are turned and radii are pressed inwards until two of the block's
faces lie in the slot's side and floor; towards the flange both changes die out.
A turn about the axis maps every surface of revolution to itself; radii change within one plain tube only.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import asin, atan2, ceil, dist, hypot, radians, sqrt

import numpy as np

from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.swept_sizing import Finer
from flexspline.geometry.outline import Meridian, SAME_mm, SAME_rad, Segment
from flexspline.geometry.shaft_shape import Slot

LEAST_STEPS = 2
"""Elements about the axis from the slot's middle to its side, at least. Judgement: a single one would span
half of the floor."""
STEP_OF_EDGE = 0.5
"""Step about the axis beside the slot, on the floor's corner, over the grading's largest edge: with that the
slot's corners and the patch edges hold alike shares of the error on the example's shaft."""
STEP_GROWTH = 1.6
"""Ratio of one step about the axis to the one before, away from the slot's side. Judgement: neighbours with a
larger ratio make flat elements."""
LARGEST_KEYED_STEP = radians(20)
"""[rad] Largest step far from the slot, where the shaft is in plain torsion. Steps of 15° and 20° change the
example's K by 6e-5; parabolas of 20° lose 2e-5 of a circle's area."""
NEAR_RATIO, FAR_RATIO, GROWTH_RATIO = 0.3, 1.75, 1.6
"""Of the grading's values for the meridian: the revolved mesh repeats each triangle some 12 times, so their
number counts, and short edges at singular points alone cost few. The example's shaft: K ± 0.30 % by 15 900
elements; 0.2 and 1.5 give ± 0.15 % by 21 300; the grading as it is 0.6 % by 40 000. With 2.0 for the second a
check refuses the mesh of a shaft with a short, deep slot."""
BLOCK_EDGE_POINTS = 24
"""Points along each of the block's edges, near which the mesh is fine. They are closer to each other than any
mesh edge there is long."""


@dataclass(frozen=True)
class SlottedTube:
    """The slot and the plain tube that it is cut into; lengths [mm].

    Attributes
    ----------
    inner, outer : radii of the tube; inner 0: solid.
    fading : below the slot, the length over which the mesh goes back to a body of revolution.
    """

    slot: Slot
    inner: float
    outer: float
    fading: float

    @property
    def end(self) -> float:
        """z of the free end [mm]."""
        return self.slot.start + self.slot.length

    @property
    def corner(self) -> float:
        """Radius of the floor's corners [mm]."""
        return hypot(self.slot.floor, self.slot.half_width)

    @property
    def angle(self) -> float:
        """Angle of the floor's corner [rad]."""
        return atan2(self.slot.half_width, self.slot.floor)

    @property
    def edges(self) -> tuple[Segment, Segment]:
        """The block's edges in the meridian: from the free end along the corner's radius, then outwards."""
        inside = (self.corner, self.slot.start)
        return (
            Segment((self.corner, self.end), inside),
            Segment(inside, (self.outer, self.slot.start)),
        )

    @property
    def land(self) -> float:
        """Material between the floor's middle and the bore, or the axis [mm]."""
        return self.slot.floor - self.inner

    def grading(self, plain: Grading) -> Grading:
        """Return the grading that gives the same error on a revolved mesh of many steps."""
        return Grading(NEAR_RATIO * plain.near, FAR_RATIO * plain.far, GROWTH_RATIO * plain.growth)

    def finer(self, grading: Grading) -> Finer:
        """What the meridian must have beside the grading: shorter edges along `edges`, where the stress
        is singular, as the side and the floor are all of the slot's length."""
        along = np.linspace(0, 1, BLOCK_EDGE_POINTS)
        places = np.vstack([s.at(along) for s in self.edges])
        edge = sqrt(grading.near * grading.far)
        return Finer(LARGEST_KEYED_STEP, tuple(map(tuple, places.tolist())), edge_mm=edge)

    def outline(self, whole: Meridian) -> Meridian:
        """Return the outline with a vertex where each of the block's edges ends."""
        ends = [(self.corner, self.end), (self.outer, self.slot.start)]
        segments: list[Segment] = []
        for s in whole.segments:
            on = [p for p in ends if _within(s, p)]
            for p in on:
                segments.append(Segment(s.start, p, patch=s.patch))
                s = Segment(p, s.end, patch=s.patch)
            segments.append(s)
        return Meridian(tuple(segments))

    def step_rad(self, far: float) -> float:
        """Return the step about the axis, a whole share of the slot's half angle; `far` as in Grading."""
        steps = ceil(self.angle * self.corner / (STEP_OF_EDGE * far))
        return self.angle / max(LEAST_STEPS, steps)

    def angles(self, sector: float, far: float) -> np.ndarray:
        """Return angles from 0 to `sector` [rad]: even over the slot, then by growing steps."""
        first = self.step_rad(far)
        left = sector - self.angle
        steps = [first]
        while sum(steps) < left:
            steps.append(min(LARGEST_KEYED_STEP, STEP_GROWTH * steps[-1]))
        beyond = np.cumsum(steps) * left / sum(steps)
        return np.concatenate(
            [np.arange(0, self.angle - SAME_rad, first), [self.angle], self.angle + beyond]
        )

    def side(self, angles: np.ndarray) -> float:
        """Return the angle of the mesh [rad] that is moved onto the slot's side: the nearest one except 0."""
        others = angles[angles > SAME_rad]
        return float(others[np.abs(others - self.angle).argmin()])

    def holds(self, polar: np.ndarray, side: float) -> np.ndarray:
        """Return the mask (m,) of the places (m, 3) as (r, φ, z) of the unbent mesh within the block."""
        r, phi, z = polar.T
        return (r > self.corner) & (phi < side) & (z > self.slot.start)

    def bent(self, polar: np.ndarray, side: float, sector: float) -> np.ndarray:
        """Return nodes (n, 3) as (r, φ, z) with the block's faces on the slot; `side` is its angle [rad]."""
        r, phi, z = polar.T
        share = np.clip(1 - (self.slot.start - z) / self.fading, 0, 1)
        wall = np.arcsin(np.minimum(1.0, self.slot.half_width / np.maximum(r, self.corner)))
        wall = (1 - share) * side + share * wall
        turned = np.where(
            phi < side, phi * wall / side, wall + (phi - side) * (sector - wall) / (sector - side)
        )
        within = np.minimum(1.0, phi / side)  # 1: in the side's plane and beyond, no radius changes
        floor = self.slot.floor / np.cos(within * self.angle)
        floor = (1 - share) * self.corner + share * floor
        pressed = np.where(
            r < self.corner,
            self.inner + (r - self.inner) * (floor - self.inner) / (self.corner - self.inner),
            self.outer - (self.outer - r) * (self.outer - floor) / (self.outer - self.corner),
        )
        movable = (r > self.inner) & (r < self.outer)
        return np.column_stack([np.where(movable, pressed, r), turned, z])

    @property
    def mouth_rad(self) -> float:
        """Angle of the slot's side at the outer wall [rad]."""
        return asin(self.slot.half_width / self.outer)

    @property
    def half_volume(self) -> float:
        """Volume of the slot's half at angles from 0 on [mm³]."""
        return self.slot.length * self.slot.section_mm2(self.outer) / 2

    def half_mouth(self, outline: Meridian, patch: str) -> float:
        """Return the area that the slot's half takes from a patch on the outer wall [mm²]."""
        on_wall = [s for s in outline.segments if s.patch == patch and s.start[0] == s.end[0]]
        lengths = [
            max(s.start[1], s.end[1]) - max(self.slot.start, min(s.start[1], s.end[1]))
            for s in on_wall
            if abs(s.start[0] - self.outer) < SAME_mm
        ]
        return self.outer * self.mouth_rad * sum(max(0.0, length) for length in lengths)

    def cuts(self, points: np.ndarray) -> np.ndarray:
        """Return the mask (n,) of points (n, 3) [mm] inside the slot."""
        x, y, z = points.T
        inside = (x > self.slot.floor) & (np.abs(y) < self.slot.half_width - SAME_mm)
        return inside & (z > self.slot.start + SAME_mm)

    def rims(self, spacing: float) -> np.ndarray:
        """Return points (k, 3) every `spacing` mm along the slot's edges, for angles from 0 on."""
        floor, half, start = self.slot.floor, self.slot.half_width, self.slot.start
        side = sqrt(self.outer**2 - half**2)
        corners = [(floor, 0.0), (floor, half), (side, half)]
        lines = [((*a, z), (*b, z)) for z in (start, self.end) for a, b in pairwise(corners)]
        lines += [((*a, start), (*a, self.end)) for a in corners[1:]]
        points = []
        for a, b in lines:
            count = max(2, ceil(dist(a, b) / spacing) + 1)
            points.append(np.linspace(a, b, count))
        turn = np.linspace(
            0, self.mouth_rad, max(2, ceil(self.outer * self.mouth_rad / spacing) + 1)
        )
        arc = self.outer * np.column_stack([np.cos(turn), np.sin(turn)])
        points.append(np.column_stack([arc, np.full(len(arc), start)]))
        return np.vstack(points)


def _within(s: Segment, p: tuple[float, float]) -> bool:
    """Whether a point lies inside a straight segment, its ends left out."""
    if s.centre is not None:
        return False
    near = s.nearest(np.array([p]))[0]
    ends = min(hypot(p[0] - e[0], p[1] - e[1]) for e in (s.start, s.end))
    return bool(hypot(near[0] - p[0], near[1] - p[1]) < SAME_mm < ends)
