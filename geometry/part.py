"""One part of a gear, the flexspline or the shaft: its shape, its material, and derived values."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import hypot, inf
from typing import Any

from flexspline.geometry.bolts import BoltCircle
from flexspline.geometry.listed import joined
from flexspline.geometry.material import Material
from flexspline.geometry.outline import Meridian, SAME_mm
from flexspline.geometry.part_name import PartName
from flexspline.geometry.shaft_shape import Shaft, Slot
from flexspline.geometry.shapes import Flexspline

NO_HOLES: dict[str, Any] = {
    "bolt_count": 0,
    "bolt_circle_diameter_mm": None,
    "bolt_hole_diameter_mm": None,
}
SHARE_OF_RADIUS = 1 / 20
"""Of the shaft's least outer radius, in the stress rule. A shaft's wall is often most of its radius; one
such wall from every edge would leave out its fillets, which count in full. What a rigid grip adds at its
edge has died out by a small share of the radius: at 1/20 the peaks of the examples' shafts lie in their
fillets, at 1/45 at the grip."""


@dataclass(frozen=True)
class Part:
    """The flexspline or the shaft."""

    shape: Flexspline | Shaft
    material: Material

    @property
    def name(self) -> PartName:
        """Its table in the design file."""
        return "shaft" if isinstance(self.shape, Shaft) else "flexspline"

    @property
    def driven(self) -> str:
        """The patch that the torque turns; the patch `mount` is held."""
        return "grip" if isinstance(self.shape, Shaft) else "mesh"

    @cached_property
    def meridian(self) -> Meridian:
        """The outline in the (r, z) half plane, holes and keyway left out."""
        return self.shape.meridian()

    @property
    def length(self) -> float:
        """Along the axis [mm]."""
        return self.shape.length

    @property
    def bolts(self) -> BoltCircle | None:
        """The bolt holes, from z = 0 to `hole_depth`; None where there are none."""
        return self.shape.bolts

    @property
    def hole_depth(self) -> float:
        """z at which the bolt holes end [mm]."""
        return self.shape.hole_depth

    @property
    def keyway(self) -> Slot | None:
        """The slot of a shaft's keyway."""
        return self.shape.slot if isinstance(self.shape, Shaft) else None

    @property
    def is_revolved(self) -> bool:
        """Whether the part is a body of revolution: no bolt holes, no keyway."""
        return self.bolts is None and self.keyway is None

    @property
    def cuts(self) -> str:
        """What makes it no body of revolution, in words; empty where it is one."""
        holes, keyway = self.bolts is not None, self.keyway is not None
        return joined(["holes"] * holes + ["keyway"] * keyway, "and")

    @property
    def cuts_meet(self) -> bool:
        """Whether a bolt hole opens into the keyway, or touches it."""
        bolts, slot = self.bolts, self.keyway
        if bolts is None or slot is None or self.hole_depth < slot.start - SAME_mm:
            return False
        away = (
            hypot(max(slot.floor - x, 0.0), max(abs(y) - slot.half_width, 0.0))
            for x, y in bolts.centres
        )
        return min(away) < bolts.hole_radius + SAME_mm

    @property
    def ligament_mm(self) -> float:
        """The thinnest material between a bolt hole and the next one or an edge of the part [mm].

        Infinite where there are no holes.
        """
        bolts = self.bolts
        if bolts is None:
            return inf
        ends = (end for segment in self.meridian.segments for end in (segment.start, segment.end))
        edges = [r for r, z in ends if z < self.hole_depth + SAME_mm and r > 0]
        inside = [bolts.inner - r for r in edges if r < bolts.inner]
        outside = [r - bolts.outer for r in edges if r > bolts.outer]
        return min(*inside, *outside, bolts.pitch - 2 * bolts.hole_radius, inf)

    def without_holes(self) -> Part:
        """The body of revolution that it would be: no bolt holes, no keyway."""
        if self.is_revolved:
            return self
        filled = NO_HOLES | ({"keyway": None} if isinstance(self.shape, Shaft) else {})
        return replace(self, shape=self.shape.model_copy(update=filled))

    @property
    def exclusion_mm(self) -> float:
        """Points nearer than this to a sharp edge or a patch edge count for no peak stress [mm].

        One wall thickness: the flexspline's `wall_thickness_mm`; the shaft's thinnest wall, and at most
        SHARE_OF_RADIUS of its least outer radius.
        """
        if not isinstance(self.shape, Shaft):
            return self.shape.wall_thickness_mm
        walls = [(s.outer_diameter_mm - s.inner_diameter_mm) / 2 for s in self.shape.segment]
        radius = min(s.outer_diameter_mm for s in self.shape.segment) / 2
        return min(*walls, SHARE_OF_RADIUS * radius)
