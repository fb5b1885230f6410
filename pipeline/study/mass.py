"""What a part weighs: its meridian revolved (Pappus), less holes and keyway, times the density."""

from __future__ import annotations

from math import asin, pi, sqrt

from geometry.design import Cup, Design, Shaft
from geometry.meridian import meridian

DENSITY_KG_M3 = 7850.0
"""Steel's. The design file has no density; mass only compares designs of one material."""
_GRAMS_PER_MM3 = DENSITY_KG_M3 * 1e-6


def part_mass_g(design: Design, part: str) -> float:
    """Mass [g] of ``"flexspline"`` or ``"shaft"`` at DENSITY_KG_M3, teeth left out."""
    volume = meridian(design, part).volume - _holes(design, part)
    if part == "shaft":
        volume -= _keyway(design.shaft)
    return volume * _GRAMS_PER_MM3


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
