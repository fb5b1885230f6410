"""The hat (silk hat): its keys, its profile and its first design, which has the first cup's tube, shorter."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from flexspline.geometry.fields import Length
from flexspline.geometry.flexspline_shape import FirstDesign, FlexsplineShape, Land
from flexspline.geometry.outline import Meridian, Segment
from flexspline.geometry.profile import Corner, closed
from flexspline.geometry.toml_text import TomlTable

FIRST_FLEXSPLINE: TomlTable = {
    "kind": "hat",
    "inner_diameter_mm": 38.4,
    "wall_thickness_mm": 0.4,
    "ring_thickness_mm": 0.55,
    "length_mm": 22.0,
    "ring_width_mm": 8.0,
    "ring_offset_mm": 0.0,
    "diaphragm_thickness_mm": 0.4,
    "flange_outer_diameter_mm": 68.0,
    "flange_inner_diameter_mm": 54.0,
    "flange_thickness_mm": 3.0,
    "inner_fillet_mm": 1.0,
    "outer_fillet_mm": 1.0,
    "teeth": "none",
    "tooth_flank": "involute",
    "bolt_count": 12,
    "bolt_circle_diameter_mm": 61.0,
    "bolt_hole_diameter_mm": 3.2,
}
FIRST_SHAFT: TomlTable = {
    "bolt_count": 12,
    "bolt_circle_diameter_mm": 61.0,
    "bolt_hole_diameter_mm": 3.2,
    "fillet_mm": 1.0,
    "grip_length_mm": 10.0,
    "segment": [
        {"length_mm": 6.0, "outer_diameter_mm": 68.0, "inner_diameter_mm": 20.0},
        {"length_mm": 18.0, "outer_diameter_mm": 32.0, "inner_diameter_mm": 20.0},
    ],
    "keyway": {"width_mm": 5.0, "depth_mm": 3.0, "length_mm": 10.0},
}


class Hat(FlexsplineShape):
    """A hat (silk hat): the diaphragm runs outwards to a bolted flange."""

    land = Land(
        "flange", "flange_inner_diameter_mm", "flange_outer_diameter_mm", "flange_thickness_mm"
    )
    inward = False
    first = FirstDesign(
        FIRST_FLEXSPLINE,
        FIRST_SHAFT,
        named="`flexspline init hat`",
        lowers_stress="A longer tube or a narrower ring lowers the stress",
        overstressed=True,
        overstressed_below=144,  # at ratio 100: 718 MPa, and the steel endures 500
    )
    kind: Literal["hat"]
    flange_outer_diameter_mm: Length = Field(description="mm, outside of the bolted flange")
    flange_inner_diameter_mm: Length = Field(description="mm, where the flange's thick part begins")
    flange_thickness_mm: Length = Field(description="mm, from z = 0")

    def meridian(self) -> Meridian:
        """Up the outside, down the inside (docs/contract.md)."""
        outer, inner = self.flange_outer_diameter_mm / 2, self.flange_inner_diameter_mm / 2
        h = self.diaphragm_thickness_mm
        corners = [
            Corner((self.inner_radius, 0.0), fillet=self.outer_fillet_mm),
            Corner((inner, 0.0)),
            Corner((outer, 0.0), "mount"),
            Corner((outer, self.flange_thickness_mm)),
            Corner((inner, self.flange_thickness_mm)),
            Corner((inner, h)),
            Corner((self.wall_radius, h), fillet=self.inner_fillet_mm),
            *self.ring_corners,
        ]
        return closed(corners, [*self.ring_cuts, Segment((inner, 0.0), (inner, h))])
