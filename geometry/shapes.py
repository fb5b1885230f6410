"""The kinds of flexspline as the design file states them: cup and hat."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal, get_args

from pydantic import Field

from flexspline.geometry.bolts import Bolted
from flexspline.geometry.fields import Length, LengthOrZero


@dataclass(frozen=True)
class Land:
    """The thick part of a flexspline's closed end, which bolts to the shaft: its noun, and the design keys of
    its two diameters and its thickness."""

    noun: str
    inner: str
    outer: str
    thickness: str


_KINDS_IN_WORDS = "cup or hat"


class _Flexspline(Bolted):
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
    kind: Literal["cup"] = Field(description=_KINDS_IN_WORDS)
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
    kind: Literal["hat"] = Field(description=_KINDS_IN_WORDS)
    flange_outer_diameter_mm: Length = Field(description="mm, outside of the bolted flange")
    flange_inner_diameter_mm: Length = Field(description="mm, where the flange's thick part begins")
    flange_thickness_mm: Length = Field(description="mm, from z = 0")


Flexspline = Cup | Hat
KINDS: tuple[str, ...] = tuple(
    get_args(c.model_fields["kind"].annotation)[0] for c in get_args(Flexspline)
)
"""What `flexspline.kind` may be."""
