"""The cup: its keys, its profile and its first design.

The first design is that of examples/xb1-40.toml, which leaves out what has a default; but its shaft is 17 mm
in diameter where that has 18: the keyway offered is a usual one there.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from flexspline.geometry.fields import Length, LengthOrZero
from flexspline.geometry.flexspline_shape import FirstDesign, FlexsplineShape, Land
from flexspline.geometry.outline import Meridian, Segment
from flexspline.geometry.profile import Corner, closed
from flexspline.geometry.toml_text import TomlTable

FIRST_FLEXSPLINE: TomlTable = {
    "kind": "cup",
    "inner_diameter_mm": 38.4,
    "wall_thickness_mm": 0.4,
    "ring_thickness_mm": 0.55,
    "length_mm": 30.0,
    "ring_width_mm": 8.0,
    "ring_offset_mm": 0.0,
    "diaphragm_thickness_mm": 0.6,
    "boss_diameter_mm": 18.0,
    "boss_thickness_mm": 3.0,
    "bore_diameter_mm": 8.0,
    "inner_fillet_mm": 1.0,
    "outer_fillet_mm": 1.0,
    "teeth": "none",
    "tooth_flank": "involute",
    "bolt_count": 6,
    "bolt_circle_diameter_mm": 13.0,
    "bolt_hole_diameter_mm": 2.5,
}
FIRST_SHAFT: TomlTable = {
    "bolt_count": 6,
    "bolt_circle_diameter_mm": 13.0,
    "bolt_hole_diameter_mm": 2.5,
    "fillet_mm": 0.5,
    "grip_length_mm": 10.0,
    "segment": [
        {"length_mm": 4.0, "outer_diameter_mm": 20.0, "inner_diameter_mm": 6.0},
        {"length_mm": 24.0, "outer_diameter_mm": 17.0, "inner_diameter_mm": 6.0},
    ],
    "keyway": {"width_mm": 5.0, "depth_mm": 3.0, "length_mm": 10.0},
}


class Cup(FlexsplineShape):
    """A cup: the closed end carries a thick boss that bolts to the shaft."""

    land = Land("boss", "bore_diameter_mm", "boss_diameter_mm", "boss_thickness_mm")
    inward = True
    first = FirstDesign(
        FIRST_FLEXSPLINE,
        FIRST_SHAFT,
        named="examples/xb1-40.toml",
        lowers_stress="Thinner parts lower the stress",
        overstressed_below=90,  # at ratio 100: 448 MPa, and the steel endures 500
    )
    kind: Literal["cup"]
    boss_diameter_mm: Length = Field(description="mm, thick centre that bolts to the shaft")
    boss_thickness_mm: Length = Field(description="mm, from z = 0")
    bore_diameter_mm: LengthOrZero = Field(
        default=0.0, description="mm, through hole in the boss; 0: none"
    )

    def meridian(self) -> Meridian:
        """Up the outside, down the inside (docs/contract.md)."""
        bore, boss = self.bore_diameter_mm / 2, self.boss_diameter_mm / 2
        h = self.diaphragm_thickness_mm
        corners = [
            Corner((bore, 0.0)),
            Corner((boss, 0.0), "mount"),
            Corner((self.wall_radius, 0.0), fillet=self.outer_fillet_mm),
            *self.ring_corners,
            Corner((self.inner_radius, h), fillet=self.inner_fillet_mm),
            Corner((boss, h)),
            Corner((boss, self.boss_thickness_mm)),
            Corner((bore, self.boss_thickness_mm)),
        ]
        return closed(corners, [*self.ring_cuts, Segment((boss, 0.0), (boss, h))])
