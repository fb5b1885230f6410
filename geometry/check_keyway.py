"""Checks of a keyway: within the shaft, above its bore, narrower than the chord at its floor."""

from __future__ import annotations

from collections.abc import Iterator
from math import sqrt

from flexspline.geometry.bounds import GAP_mm, below, lengths
from flexspline.geometry.errors import DesignError
from flexspline.geometry.shaft_shape import Keyway, Shaft


def keyway_faults(s: Shaft, key: Keyway, floor: float) -> Iterator[DesignError]:
    """What keeps the slot from being cut; `floor` [mm]: the distance of its floor from the axis."""
    last = s.segment[-1]
    radius = last.outer_diameter_mm / 2
    if key.length_mm >= s.length - GAP_mm:
        yield DesignError(
            "shaft.keyway.length_mm",
            key.length_mm,
            f"must be {lengths(0, below(s.length))} mm: below the shaft's length, {s.length:g} mm (sum "
            "of segment length_mm)",
        )
        return
    bored = [
        (segment.inner_diameter_mm / 2, i)
        for i, segment in enumerate(s.segment)
        if sum(t.length_mm for t in s.segment[: i + 1]) > s.length - key.length_mm + GAP_mm
        and segment.outer_diameter_mm / 2 > floor
    ]
    bore, i = max(bored, default=(last.inner_diameter_mm / 2, len(s.segment) - 1))
    if floor <= bore + GAP_mm:
        room = lengths(0, below(radius - bore))
        lands = (
            f"from the last outer_diameter_mm = {2 * radius:g} to segment[{i}].inner_diameter_mm = "
            f"{2 * bore:g}"
        )
        if room is None:
            yield DesignError(
                "shaft.keyway", key.model_dump(), f"must be left out: no depth fits {lands}"
            )
        else:
            yield DesignError("shaft.keyway.depth_mm", key.depth_mm, f"must be {room} mm: {lands}")
        return
    chord = 2 * sqrt(radius**2 - floor**2)
    if key.width_mm >= chord - GAP_mm:
        yield DesignError(
            "shaft.keyway.width_mm",
            key.width_mm,
            f"must be {lengths(0, below(chord))} mm: below the chord {chord:.4g} mm at depth_mm = "
            f"{key.depth_mm:g} in outer_diameter_mm = {2 * radius:g}",
        )
