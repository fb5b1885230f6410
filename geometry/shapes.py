"""The shapes of the parts as the design file states them: cup or hat, and shaft."""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, cos, pi, sin, sqrt
from typing import ClassVar, Literal, get_args

from pydantic import Field

from flexspline.geometry.fields import BoltCount, DesignTable, Length, LengthOrZero


@dataclass(frozen=True)
class BoltCircle:
    """Equal holes on a circle, the first at angle 0; lengths in mm."""

    count: int
    radius: float
    hole_radius: float

    @property
    def centres(self) -> list[tuple[float, float]]:
        """(x, y) of every hole's axis [mm]."""
        angles = (2 * pi * k / self.count for k in range(self.count))
        return [(self.radius * cos(a), self.radius * sin(a)) for a in angles]


class _Bolted(DesignTable):
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


@dataclass(frozen=True)
class Land:
    """The thick part of a flexspline's closed end, which bolts to the shaft: its noun, and the design keys of
    its two diameters and its thickness."""

    noun: str
    inner: str
    outer: str
    thickness: str


class _Flexspline(_Bolted):
    land: ClassVar[Land]
    inward: ClassVar[bool]
    """Whether the closed end lies inside the tube."""

    inner_diameter_mm: Length = Field(description="mm, of the tube, under the wave generator")
    wall_thickness_mm: Length = Field(description="mm, of the smooth tube")
    ring_thickness_mm: Length = Field(
        description="mm, toothed ring, from inner surface to tooth root"
    )
    length_mm: Length = Field(description="mm, closed end's outer face (z = 0) to the open rim")
    ring_width_mm: Length = Field(description="mm, axial length of the toothed ring")
    ring_offset_mm: LengthOrZero = Field(
        default=0.0, description="mm, open rim to the ring's near edge"
    )
    diaphragm_thickness_mm: Length = Field(description="mm, of the closed end's thin disc")
    inner_fillet_mm: LengthOrZero = Field(
        default=0.0, description="mm, radius of the inside corner of tube and diaphragm; 0: sharp"
    )
    outer_fillet_mm: LengthOrZero = Field(
        default=0.0, description="mm, radius of the outside corner of the closed end; 0: sharp"
    )
    teeth: Literal["none", "drawn"] = Field(
        default="none",
        description="none: plain ring; drawn: a ring as stiff as the teeth and the rim under them",
    )
    tooth_flank: Literal["involute", "trapezoid"] = Field(
        default="involute", description="involute or trapezoid, where teeth are drawn"
    )

    def size(self, key: str) -> float:
        """The value of a key that holds a length [mm]."""
        return float(getattr(self, key))

    @property
    def land_edge(self) -> str:
        """The key of the diameter where the diaphragm meets the land."""
        return self.land.outer if self.inward else self.land.inner

    @property
    def hole_depth(self) -> float:
        """z at which the bolt holes end [mm]: they run through the land."""
        return self.size(self.land.thickness)

    @property
    def length(self) -> float:
        """Closed end's outer face to the open rim [mm]."""
        return self.length_mm

    @property
    def inner_radius(self) -> float:
        """Ri [mm]."""
        return self.inner_diameter_mm / 2

    @property
    def wall_radius(self) -> float:
        """Rw = Ri + wall [mm]."""
        return self.inner_radius + self.wall_thickness_mm

    @property
    def ring_radius(self) -> float:
        """Rr = Ri + ring [mm], the tooth root."""
        return self.inner_radius + self.ring_thickness_mm

    @property
    def ring_end(self) -> float:
        """Upper end of the toothed ring, z [mm]."""
        return self.length_mm - self.ring_offset_mm

    @property
    def ring_start(self) -> float:
        """Lower end of the toothed ring, z [mm]."""
        return self.ring_end - self.ring_width_mm

    @property
    def shoulder_start(self) -> float:
        """Where the 45° shoulder leaves the wall, z [mm]."""
        return self.ring_start - (self.ring_radius - self.wall_radius)


class Cup(_Flexspline):
    """A cup: the closed end carries a thick boss that bolts to the shaft."""

    land = Land("boss", "bore_diameter_mm", "boss_diameter_mm", "boss_thickness_mm")
    inward = True
    kind: Literal["cup"] = Field(description="cup or hat")
    boss_diameter_mm: Length = Field(description="mm, thick centre that bolts to the shaft")
    boss_thickness_mm: Length = Field(description="mm, from z = 0")
    bore_diameter_mm: LengthOrZero = Field(
        default=0.0, description="mm, through hole in the boss; 0: none"
    )


class Hat(_Flexspline):
    """A hat (silk hat): the diaphragm runs outwards to a bolted flange."""

    land = Land(
        "flange", "flange_inner_diameter_mm", "flange_outer_diameter_mm", "flange_thickness_mm"
    )
    inward = False
    kind: Literal["hat"] = Field(description="cup or hat")
    flange_outer_diameter_mm: Length = Field(description="mm, outside of the bolted flange")
    flange_inner_diameter_mm: Length = Field(description="mm, where the flange's thick part begins")
    flange_thickness_mm: Length = Field(description="mm, from z = 0")


Flexspline = Cup | Hat
KINDS: tuple[str, ...] = tuple(
    get_args(c.model_fields["kind"].annotation)[0] for c in get_args(Flexspline)
)
"""What `flexspline.kind` may be."""


class ShaftSegment(DesignTable):
    """One cylinder of the shaft; the first is the flange on the flexspline."""

    length_mm: Length = Field(description="mm, along the axis")
    outer_diameter_mm: Length = Field(description="mm, outside")
    inner_diameter_mm: LengthOrZero = Field(default=0.0, description="mm, of the bore; 0: solid")


class Keyway(DesignTable):
    """A square-ended slot from the free end, centred at angle 0."""

    width_mm: Length = Field(description="mm, across the slot")
    depth_mm: Length = Field(description="mm, flat floor below the last segment's outer radius")
    length_mm: Length = Field(description="mm, from the free end")


@dataclass(frozen=True)
class Slot:
    """A keyway's place in the shaft: x from `floor` outwards, z from `start` to the free end [mm].

    `floor` is a plane at right angles to x; the sides are at y = ±`half_width`.
    """

    floor: float
    half_width: float
    start: float
    length: float

    def section_mm2(self, radius: float) -> float:
        """Area that the slot takes from a disc of this radius [mm]."""
        if radius <= self.floor:
            return 0.0
        reach = min(self.half_width, sqrt(radius**2 - self.floor**2))
        cap = reach * sqrt(radius**2 - reach**2) + radius**2 * asin(reach / radius)
        return cap - 2 * reach * self.floor


class Shaft(_Bolted):
    """The output shaft: segments stacked from the flange to the free end."""

    fillet_mm: LengthOrZero = Field(
        default=0.0, description="mm, radius at every inside corner where the outer diameter steps"
    )
    grip_length_mm: Length = Field(description="mm, at the free end: where the output is held")
    segment: tuple[ShaftSegment, ...] = Field(min_length=1, max_length=50, strict=False)
    keyway: Keyway | None = Field(default=None, description="optional slot from the free end")

    @property
    def length(self) -> float:
        """Total length [mm]."""
        return sum(s.length_mm for s in self.segment)

    @property
    def hole_depth(self) -> float:
        """z at which the bolt holes end [mm]: with the first segment."""
        return self.segment[0].length_mm

    @property
    def slot(self) -> Slot | None:
        """Where the keyway is; None where there is none."""
        key = self.keyway
        if key is None:
            return None
        floor = self.segment[-1].outer_diameter_mm / 2 - key.depth_mm
        return Slot(floor, key.width_mm / 2, self.length - key.length_mm, key.length_mm)
