"""What a part weighs: its meridian revolved (Pappus), less holes and keyway, times the density."""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, pi, sqrt

from flexspline.geometry.design import Cup, Design, Shaft
from flexspline.geometry.meridian import meridian

GRAMS_PER_MM3 = 1e-6
"""Of 1 kg/m³."""


@dataclass(frozen=True)
class Masses:
    """Mass of each part [g], teeth left out, and the density that gave it [kg/m³].

    `flexspline_density_stated`, `shaft_density_stated`: whether the design file gives the density; else it
    is steel's.
    """

    flexspline_g: float
    shaft_g: float
    flexspline_kg_per_m3: float
    shaft_kg_per_m3: float
    flexspline_density_stated: bool
    shaft_density_stated: bool


def masses(design: Design) -> Masses:
    """What both parts weigh."""
    flexspline, shaft = design.material_of("flexspline"), design.material_of("shaft")
    return Masses(
        part_mass_g(design, "flexspline"),
        part_mass_g(design, "shaft"),
        flexspline.density_kg_per_m3,
        shaft.density_kg_per_m3,
        flexspline.density_stated,
        shaft.density_stated,
    )


def part_mass_g(design: Design, part: str) -> float:
    """Mass [g] of ``"flexspline"`` or ``"shaft"`` of its material's density, teeth left out."""
    volume = meridian(design, part).volume - _holes(design, part)
    if part == "shaft":
        volume -= _keyway(design.shaft)
    return volume * design.material_of(part).density_kg_per_m3 * GRAMS_PER_MM3


def _holes(design: Design, part: str) -> float:
    f, shaft = design.flexspline, design.shaft
    if part == "shaft":
        bolts, depth = shaft.bolts, shaft.segment[0].length_mm
    else:
        bolts = f.bolts
        depth = f.boss_thickness_mm if isinstance(f, Cup) else f.flange_thickness_mm
    return bolts.count * pi * bolts.hole_radius**2 * depth if bolts else 0.0


def _keyway(shaft: Shaft) -> float:
    """Slot with a plane floor at the last radius less its depth, through all segments it reaches."""
    key = shaft.keyway
    if key is None:
        return 0.0
    floor = shaft.segment[-1].outer_diameter_mm / 2 - key.depth_mm
    half, left, volume = key.width_mm / 2, key.length_mm, 0.0
    for segment in reversed(shaft.segment):
        length = min(left, segment.length_mm)
        radius = segment.outer_diameter_mm / 2
        if length <= 0:
            break
        left -= length
        if radius <= floor:
            continue
        reach = min(half, sqrt(radius**2 - floor**2))
        cap = reach * sqrt(radius**2 - reach**2) + radius**2 * asin(reach / radius)
        volume += length * (cap - 2 * reach * floor)
    return volume
