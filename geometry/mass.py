"""Mass of a part: its revolved meridian (Pappus), minus holes and keyway, times the density."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from flexspline.geometry.design import Design
from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Shaft

GRAMS_PER_MM3 = 1e-6
"""Of 1 kg/m³."""


@dataclass(frozen=True)
class Masses:
    """Mass of each part [g], teeth left out."""

    flexspline_g: float
    shaft_g: float


def masses(design: Design) -> Masses:
    """What both parts weigh."""
    return Masses(*map(mass_g, design.parts))


def mass_g(part: Part) -> float:
    """Mass [g] of a part of its material's density, teeth left out."""
    volume = part.meridian.volume - _holes(part)
    if isinstance(part.shape, Shaft):
        volume -= _keyway(part.shape)
    return volume * part.material.density_kg_per_m3 * GRAMS_PER_MM3


def _holes(part: Part) -> float:
    bolts = part.bolts
    return bolts.count * pi * bolts.hole_radius**2 * part.hole_depth if bolts else 0.0


def _keyway(shaft: Shaft) -> float:
    """Slot with a plane floor, through all segments it reaches."""
    slot = shaft.slot
    if slot is None:
        return 0.0
    left, volume = slot.length, 0.0
    for segment in reversed(shaft.segment):
        length = max(0.0, min(left, segment.length_mm))
        volume += length * slot.section_mm2(segment.outer_diameter_mm / 2)
        left -= length
    return volume
