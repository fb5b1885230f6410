"""Bolt holes, as the design file states them of either part."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, inf, pi, sin

from pydantic import Field

from flexspline.geometry.fields import BoltCount, DesignTable, Length


def pitch(circle: float, count: int) -> float:
    """Chord between neighbours of `count` points on a circle of that diameter; infinite for one."""
    return circle * sin(pi / count) if count > 1 else inf


@dataclass(frozen=True)
class BoltCircle:
    """Equal holes on a circle, the first at angle 0; lengths in mm."""

    count: int
    radius: float
    hole_radius: float

    @property
    def inner(self) -> float:
        """Radius of the circle inside all holes [mm]."""
        return self.radius - self.hole_radius

    @property
    def outer(self) -> float:
        """Radius of the circle around all holes [mm]."""
        return self.radius + self.hole_radius

    @property
    def pitch(self) -> float:
        """Between the axes of neighbours, straight [mm]; infinite for one hole."""
        return pitch(2 * self.radius, self.count)

    @property
    def centres(self) -> list[tuple[float, float]]:
        """(x, y) of every hole's axis [mm]."""
        angles = (2 * pi * k / self.count for k in range(self.count))
        return [(self.radius * cos(a), self.radius * sin(a)) for a in angles]


class Bolted(DesignTable):
    """A part with a circle of bolt holes, or none."""

    bolt_count: BoltCount = Field(
        default=0, description="number of bolt holes, the first at angle 0; 0: none"
    )
    bolt_circle_diameter_mm: Length | None = Field(
        default=None, description="mm, through the holes' axes"
    )
    bolt_hole_diameter_mm: Length | None = Field(default=None, description="mm, of each hole")

    @property
    def bolts(self) -> BoltCircle | None:
        """The holes; None where there are none."""
        circle, hole = self.bolt_circle_diameter_mm, self.bolt_hole_diameter_mm
        if not self.bolt_count or circle is None or hole is None:
            return None
        return BoltCircle(self.bolt_count, circle / 2, hole / 2)
