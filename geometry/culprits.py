"""Finds the one wrong value if it contradicts several others; the error message then names this value.

Of a tube 0.03 mm long with a ring of 8 mm and a boss of 3 mm, the length is wrong, and not the other two.
"""

from __future__ import annotations

from collections.abc import Iterator

from flexspline.geometry.bounds import GAP_mm, above, below, lengths, upto
from flexspline.geometry.check_fillets import fault
from flexspline.geometry.errors import DesignError
from flexspline.geometry.fields import SMALLEST_MM
from flexspline.geometry.ranges import LENGTH_mm
from flexspline.geometry.shapes import Flexspline

CONTRADICTING = 2
"""Others that contradict a figure."""
LONGEST_WALLS = 3000
"""Of a tube's length, in walls: usual ones have 8 to 280. One layer of triangles across the wall are as many
along it; of 3000 all figures took 56 s, of 5000 two minutes, of 15 000 each first mesh alone 17 s."""


def culprits(f: Flexspline) -> Iterator[DesignError]:
    """A length, inner diameter or boss that at least two others do not fit."""
    yield from _length(f)
    yield from (_inside(f) if f.inward else _outside(f))


def least_length(f: Flexspline) -> float:
    """The tube's length with room for all that lies along it [mm]."""
    rise = max(f.ring_thickness_mm - f.wall_thickness_mm, 0.0)
    ring = f.ring_offset_mm + f.ring_width_mm
    fillet = max(f.inner_fillet_mm, f.outer_fillet_mm)
    along = f.diaphragm_thickness_mm + rise + ring + fillet
    return max(along, above(f.hole_depth)) + SMALLEST_MM


def longest_length(f: Flexspline) -> float:
    """The tube's length that LONGEST_WALLS allows [mm]."""
    return upto(LONGEST_WALLS * f.wall_thickness_mm)


def _length(f: Flexspline) -> Iterator[DesignError]:
    h, fillet = f.diaphragm_thickness_mm, max(f.inner_fillet_mm, f.outer_fillet_mm)
    ring = f.ring_offset_mm + f.ring_width_mm
    land = f.hole_depth
    if sum(x > f.length_mm + GAP_mm for x in (h, ring, land, fillet)) < CONTRADICTING:
        return
    least = least_length(f)
    room = lengths(least, longest_length(f)) or lengths(least, LENGTH_mm.high)
    if room is not None:
        yield fault(
            f,
            "length_mm",
            f"must be {room} mm: diaphragm, fillets, shoulder and ring lie along it, and the "
            f"{f.land.noun} is shorter",
        )


def least_land(f: Flexspline) -> float:
    """The outer diameter of a land with room for its bore and bolt holes [mm]."""
    return max(f.size(f.land.inner), _bolted(f)) + SMALLEST_MM


def _bolted(f: Flexspline) -> float:
    """The diameter that goes around the bolt holes [mm], 0 without."""
    circle, hole = f.bolt_circle_diameter_mm, f.bolt_hole_diameter_mm
    return circle + hole if f.bolt_count and circle and hole else 0.0


def _inside(f: Flexspline) -> Iterator[DesignError]:
    boss, bore, bolts = f.size(f.land.outer), f.size(f.land.inner), _bolted(f)
    fillet = max(f.inner_fillet_mm, f.outer_fillet_mm)
    inside = (boss, bore, bolts, fillet)
    if sum(x >= f.inner_diameter_mm - GAP_mm for x in inside) >= CONTRADICTING:
        most = max(boss, above(bore), above(bolts))
        least = lengths(most + 2 * fillet + SMALLEST_MM, LENGTH_mm.high)
        if least is not None:
            reason = (
                f"must be {least} mm: {f.land.noun}, bore, bolt holes and fillets lie inside it"
            )
            yield fault(f, "inner_diameter_mm", reason)
    elif sum(x >= boss - GAP_mm for x in (bore, bolts)) >= CONTRADICTING:
        room = lengths(least_land(f), below(f.inner_diameter_mm))
        if room is not None:
            yield fault(f, f.land.outer, f"must be {room} mm: bore and bolt holes lie inside it")


def _outside(f: Flexspline) -> Iterator[DesignError]:
    tube, fillet = 2 * f.wall_radius, max(f.inner_fillet_mm, f.outer_fillet_mm)
    flange, outer = f.size(f.land.inner), f.size(f.land.outer)
    if max(flange, outer) > tube + GAP_mm:
        return
    room = min(flange, outer)
    for key, least, most in (
        ("inner_diameter_mm", 0.0, room - 2 * f.wall_thickness_mm),
        ("wall_thickness_mm", f.length_mm / LONGEST_WALLS, (room - f.inner_diameter_mm) / 2),
    ):
        room_left = (most - 2 * fillet - SMALLEST_MM, most - SMALLEST_MM)
        range_ = lengths(least, room_left[0]) or lengths(least, room_left[1])
        if range_ is not None:
            yield fault(
                f,
                key,
                f"must be {range_} mm: the {f.land.noun} and its fillets lie outside the tube",
            )
            return
