"""What all kinds of flexspline share: the keys of tube and ring, and what each kind adds to them."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Literal

from pydantic import Field

from flexspline.geometry.bolts import Bolted
from flexspline.geometry.fields import Length, LengthOrZero
from flexspline.geometry.outline import Meridian, Segment
from flexspline.geometry.profile import Corner
from flexspline.geometry.toml_text import TomlTable


@dataclass(frozen=True)
class Land:
    """The thick part of a flexspline's closed end, which bolts to the shaft: its noun, and the design keys of
    its two diameters and its thickness."""

    noun: str
    inner: str
    outer: str
    thickness: str


@dataclass(frozen=True)
class FirstDesign:
    """The design that a new file of a kind begins with.

    Attributes
    ----------
    flexspline, shaft : their tables. named : which design it is, in words. lowers_stress : what lowers the
        stress on the wave generator. overstressed : whether the wave generator stresses the flexspline above
        its fatigue limit. overstressed_below : the ratio below which it does so at these proportions, as the
        stress goes with the stroke.
    """

    flexspline: TomlTable
    shaft: TomlTable
    named: str
    lowers_stress: str
    overstressed: bool = False
    overstressed_below: int = 0


class FlexsplineShape(Bolted):
    """A tube with a toothed ring and a closed end: what every kind of flexspline has."""

    land: ClassVar[Land]
    inward: ClassVar[bool]
    """Whether the closed end lies inside the tube."""
    first: ClassVar[FirstDesign]
    """What a new design file begins with."""

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

    @property
    def ring_corners(self) -> list[Corner]:
        """Up the outside from the tube to the open rim and down the inside to the seat's lower end."""
        ri, rw, rr = self.inner_radius, self.wall_radius, self.ring_radius
        return [
            Corner((rw, self.ring_start - (rr - rw))),
            Corner((rr, self.ring_start)),
            Corner((rr, self.ring_end), "mesh"),
            Corner((rw, self.ring_end)) if self.ring_offset_mm > 0 else Corner((rr, self.ring_end)),
            Corner((rw if self.ring_offset_mm > 0 else rr, self.length_mm)),
            Corner((ri, self.length_mm)),
            Corner((ri, self.ring_end)),
            Corner((ri, self.ring_start), "seat"),
        ]

    @property
    def ring_cuts(self) -> list[Segment]:
        """Through the material at the ring's ends, where a patch begins on a smooth surface."""
        ri, rr = self.inner_radius, self.ring_radius
        cuts = [Segment((ri, self.ring_start), (rr, self.ring_start))]
        if self.ring_offset_mm > 0:
            cuts.append(Segment((ri, self.ring_end), (self.wall_radius, self.ring_end)))
        return cuts

    @abstractmethod
    def meridian(self) -> Meridian:
        """The outline (docs/contract.md), with the patches `mount`, `mesh` and `seat`."""
