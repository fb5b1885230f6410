"""Analytic surfaces of a part: the surface of each CAD face, and the projection of nearby points onto it."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin
from typing import Protocol

import numpy as np

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.geometry.outline import Segment
from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Shaft

SYMMETRY_START = "symmetry_start"
SYMMETRY_END = "symmetry_end"
ON_SURFACE_MM = 1e-6
"""Vertices of a CAD face and nodes of a mesh are computed on their surfaces: what is farther off belongs to
another."""


class Surface(Protocol):
    """A surface with a name; `patch` is its name in docs/contract.md, or a plane of symmetry, or empty."""

    @property
    def patch(self) -> str: ...

    def project(self, points: np.ndarray) -> np.ndarray:
        """Nearest points on the surface [mm], shape (n, 3) in and out."""
        ...


@dataclass(frozen=True)
class Swept:
    """A meridian segment revolved about z; its ends bound it."""

    segment: Segment

    @property
    def patch(self) -> str:
        return self.segment.patch or ""

    def project(self, points: np.ndarray) -> np.ndarray:
        r = np.hypot(points[:, 0], points[:, 1])
        rz = self.segment.nearest(np.column_stack([r, points[:, 2]]))
        safe = np.maximum(r, ABOVE_ZERO)
        return np.column_stack([points[:, :2] * (rz[:, 0] / safe)[:, None], rz[:, 1]])


@dataclass(frozen=True)
class HoleWall:
    """A cylinder parallel to z: the wall of a bolt hole."""

    axis: tuple[float, float]
    radius: float
    patch: str = ""

    def project(self, points: np.ndarray) -> np.ndarray:
        from_axis = points[:, :2] - np.array(self.axis)
        unit = from_axis / np.maximum(np.linalg.norm(from_axis, axis=1), ABOVE_ZERO)[:, None]
        return np.column_stack([np.array(self.axis) + self.radius * unit, points[:, 2]])


@dataclass(frozen=True)
class Plane:
    """A plane through `point` with unit `normal`."""

    point: tuple[float, float, float]
    normal: tuple[float, float, float]
    patch: str = ""

    def project(self, points: np.ndarray) -> np.ndarray:
        n = np.array(self.normal)
        return points - ((points - np.array(self.point)) @ n)[:, None] * n


def sector_planes(sector_deg: float) -> list[Surface]:
    """The two planes through the axis that bound a sector; none for the whole part."""
    if sector_deg >= 360:
        return []
    a = radians(sector_deg)
    return [
        Plane((0, 0, 0), (0, -1, 0), SYMMETRY_START),
        Plane((0, 0, 0), (-sin(a), cos(a), 0), SYMMETRY_END),
    ]


def part_surfaces(part: Part, sector_deg: float) -> list[Surface]:
    """Every surface that a face of the part may lie on; earlier ones win where two coincide."""
    surfaces: list[Surface] = sector_planes(sector_deg)
    surfaces += [Swept(s) for s in part.meridian.segments if not s.on_axis]
    if part.bolts is not None:
        surfaces += [HoleWall(centre, part.bolts.hole_radius) for centre in part.bolts.centres]
    if isinstance(part.shape, Shaft):  # its holes may be blind
        surfaces.append(Plane((0, 0, part.hole_depth), (0, 0, 1)))
    if part.keyway is not None:
        slot = part.keyway
        surfaces += [
            Plane((slot.floor, 0, 0), (1, 0, 0)),
            Plane((0, slot.half_width, 0), (0, 1, 0)),
            Plane((0, -slot.half_width, 0), (0, 1, 0)),
            Plane((0, 0, slot.start), (0, 0, 1)),
        ]
    return surfaces
