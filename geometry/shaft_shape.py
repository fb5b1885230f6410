"""The output shaft as the design file states it: its segments, its keyway and its profile."""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, sqrt

from pydantic import Field

from flexspline.geometry.bolts import Bolted
from flexspline.geometry.fields import DesignTable, Length, LengthOrZero
from flexspline.geometry.outline import Meridian, SAME_mm, Segment
from flexspline.geometry.profile import Corner, closed


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


class Shaft(Bolted):
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

    def meridian(self) -> Meridian:
        """Up the outside, down the bore (docs/contract.md); a fillet at every inside corner outside."""
        grip_start = self.length - self.grip_length_mm
        outer: list[Corner] = []
        inner: list[Corner] = []
        cuts: list[Segment] = []
        radii = [0.0, *(s.outer_diameter_mm / 2 for s in self.segment), 0.0]
        z = 0.0
        for i, segment in enumerate(self.segment):
            top = z + segment.length_mm
            if i == len(self.segment) - 1:
                top = self.length  # the same rounding as grip_start's
            below, r, above = radii[i : i + 3]
            bore = segment.inner_diameter_mm / 2
            low, high = (
                self.fillet_mm if beside > r + SAME_mm else 0.0 for beside in (below, above)
            )
            outer.append(Corner((r, z), None if i else "mount", low))
            if z + SAME_mm < grip_start < top - SAME_mm:
                outer.append(Corner((r, grip_start)))
                cuts.append(Segment((bore, grip_start), (r, grip_start)))
            outer.append(Corner((r, top), "grip" if grip_start < top - SAME_mm else None, high))
            inner += [Corner((bore, z)), Corner((bore, top))]
            z = top
        return closed([inner[0], *outer, *inner[:0:-1]], cuts)
