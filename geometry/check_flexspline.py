"""Checks of a flexspline: fillets that fit, a ring on the tube, holes inside their land."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from flexspline.geometry.bounds import (
    GAP_mm,
    Interval,
    above,
    below,
    beside,
    from_zero,
    is_step,
    lengths,
    upto,
)
from flexspline.geometry.check_bolts import bolt_faults
from flexspline.geometry.check_fillets import PREFIX, fault, fillet_faults
from flexspline.geometry.culprits import (
    LONGEST_WALLS,
    culprits,
    least_land,
    least_length,
    longest_length,
)
from flexspline.geometry.errors import DesignError, plain_number
from flexspline.geometry.fields import SMALLEST_MM
from flexspline.geometry.ranges import LENGTH_mm
from flexspline.geometry.shapes import Flexspline


def flexspline_faults(f: Flexspline, teeth: Interval = (0.0, inf)) -> Iterator[DesignError]:
    """Everything that keeps the flexspline from being built, in the order to mend it.

    Each names a key and a range that holds whatever the keys named after it are; `teeth` are the ends that
    drawn teeth set to the ring's thickness [mm].
    """
    wrong = list(culprits(f))
    yield from wrong
    yield from _slender_faults(f)
    ring = list(_ring_faults(f, teeth))
    end = list(_inside_faults(f) if f.inward else _outside_faults(f, not ring))
    yield from ring
    yield from end
    if not ring and not end:  # the room for fillets is only defined then
        yield from fillet_faults(f)
    inner, outer = f.land.inner, f.land.outer
    yield from bolt_faults(PREFIX, f, (inner, f.size(inner)), (outer, f.size(outer)))


def _slender_faults(f: Flexspline) -> Iterator[DesignError]:
    most, least = longest_length(f), f.length_mm / LONGEST_WALLS
    if most < f.length_mm <= LENGTH_mm.high:
        long = "a longer tube is in no gear, and its mesh takes minutes"
        room = lengths(least_length(f), most)
        if room is None:  # what lies along the tube is longer: the wall is wrong
            thick = lengths(least, f.ring_thickness_mm) or lengths(least, LENGTH_mm.high)
            reason = (
                f"must be {thick} mm: length_mm = {f.length_mm:g} is at most {LONGEST_WALLS} walls"
            )
            yield fault(f, "wall_thickness_mm", f"{reason} ({long})")
            return
        yield fault(
            f,
            "length_mm",
            f"must be {room} mm: up to {LONGEST_WALLS} times wall_thickness_mm = "
            f"{f.wall_thickness_mm:g} ({long}); or make that at least {plain_number(least, 4)}",
        )


def _ring_faults(f: Flexspline, teeth: Interval) -> Iterator[DesignError]:
    h, length, wall = f.diaphragm_thickness_mm, f.length_mm, f.wall_thickness_mm
    rise = f.ring_thickness_mm - wall
    if h > upto(length - SMALLEST_MM):
        room = lengths(0, upto(length - SMALLEST_MM))
        if room is None:
            least = lengths(2 * SMALLEST_MM, LENGTH_mm.high)
            yield fault(f, "length_mm", f"must be {least} mm: for a diaphragm and a ring")
        else:
            yield fault(
                f, "diaphragm_thickness_mm", f"must be {room} mm: below length_mm = {length:g}"
            )
        return
    seat_floor, shoulder_floor = (h, 0.0) if f.inward else (0.0, h)
    room_of = min(length - seat_floor, length - shoulder_floor - rise)
    tube = f"length_mm = {length:g} less diaphragm_thickness_mm = {h:g}"
    if not is_step(rise) or room_of < SMALLEST_MM - GAP_mm / 2:
        room_for = _ring_span(wall, (teeth[0], min(teeth[1], thickest_ring(f))))
        if not room_for:
            reason = 'must be "none": wall and length leave no room for a ring with teeth'
            yield fault(f, "teeth", reason)
            return
        why = ""
        if rise < 0:
            why = (
                f": not thinner than wall_thickness_mm = {wall:g}; or make that at most "
                f"{f.ring_thickness_mm:g}"
            )
        elif is_step(rise):
            why = (
                f": its 45° shoulder rises over ring_thickness_mm - wall_thickness_mm within {tube}"
            )
        yield fault(f, "ring_thickness_mm", f"must be {room_for} mm{why}")
    elif f.ring_offset_mm > upto(max(room_of - SMALLEST_MM, 0.0)):
        most_offset = from_zero(upto(max(room_of - SMALLEST_MM, 0.0)))
        yield fault(
            f,
            "ring_offset_mm",
            f"must be {most_offset} mm: below {room_of:g}, {tube}, less the shoulder",
        )
    elif f.ring_offset_mm + f.ring_width_mm > room_of + GAP_mm:
        left = lengths(0, max(upto(room_of - f.ring_offset_mm), SMALLEST_MM))
        yield fault(
            f,
            "ring_width_mm",
            f"must be {left} mm: the ring, ring_offset_mm = {f.ring_offset_mm:g} and a shoulder of "
            f"{rise:g} mm must fit the tube ({tube})",
        )


def thickest_ring(f: Flexspline) -> float:
    """The ring's thickness whose shoulder fills the tube, but for the thinnest ring [mm]."""
    floor = 0.0 if f.inward else f.diaphragm_thickness_mm
    return upto(f.wall_thickness_mm + f.length_mm - floor - SMALLEST_MM)


def _ring_span(wall: float, ends: Interval) -> str:
    """What the ring's thickness may be, in words; "" where nothing lies between the ends."""
    low, high = max(ends[0], wall), max(ends[1], wall)
    return beside(wall, "wall_thickness_mm", SMALLEST_MM, low, high) if low <= high else ""


def _inside_faults(f: Flexspline) -> Iterator[DesignError]:
    inner, outer = f.land.inner, f.land.outer
    if f.size(outer) >= f.inner_diameter_mm - GAP_mm:
        most = below(f.inner_diameter_mm)
        room = lengths(least_land(f), most) or lengths(0, most)
        if room is None:
            least = lengths(2 * SMALLEST_MM, LENGTH_mm.high)
            reason = f"must be {least} mm: for a {f.land.noun} inside it"
            yield fault(f, "inner_diameter_mm", reason)
        else:
            reason = f"must be {room} mm: below inner_diameter_mm = {f.inner_diameter_mm:g}"
            yield fault(f, outer, reason)
    if f.size(inner) >= f.size(outer) - GAP_mm:
        room = from_zero(below(f.size(outer)))
        yield fault(f, inner, f"must be {room} mm: below {outer} = {f.size(outer):g}")
    yield from _thickness_faults(f, f.length_mm)


def _outside_faults(f: Flexspline, ring_fits: bool) -> Iterator[DesignError]:
    inner, outer = f.size(f.land.inner), f.size(f.land.outer)
    most = LENGTH_mm.high - 2 * SMALLEST_MM  # the flange itself goes around it
    if 2 * f.ring_radius > most - 2 * SMALLEST_MM:
        # a ring as thin as the wall is the least; the wall must leave room for it too
        yield from _too_wide(f, most - 2 * SMALLEST_MM)
        return
    least = above(2 * f.wall_radius)
    touches = _touches(f)
    if ring_fits and touches - GAP_mm < f.diaphragm_thickness_mm:
        least = max(least, _clear_of_the_ring(f))
    if inner <= 2 * f.wall_radius + GAP_mm or inner < least - 2 * GAP_mm or inner > most:
        yield fault(
            f,
            f.land.inner,
            f"must be {lengths(least, most)} mm: above the tube's outside, inner_diameter_mm + 2 "
            f"wall_thickness_mm = {2 * f.wall_radius:g}, with room for the ring and for "
            f"{f.land.outer}",
        )
        return
    if outer <= inner + GAP_mm:
        yield fault(
            f,
            f.land.outer,
            f"must be {lengths(above(inner), LENGTH_mm.high)} mm: above {f.land.inner} = {inner:g}",
        )
    yield from _thickness_faults(f, min(f.length_mm, touches) if ring_fits else f.length_mm)


def _touches(f: Flexspline) -> float:
    """The height that a flange taller than the shoulder must leave to the ring inside it [mm]."""
    inner = f.size(f.land.inner) / 2
    if inner > f.ring_radius + GAP_mm:
        return inf
    return f.ring_start - max(0.0, f.ring_radius - inner)


def _clear_of_the_ring(f: Flexspline) -> float:
    """Smallest diameter at which a flange as thin as the diaphragm clears the ring [mm]."""
    under = f.ring_start - f.diaphragm_thickness_mm - 2 * GAP_mm
    return 2 * (f.ring_radius - under) + 2 * GAP_mm if under > 0 else 2 * f.ring_radius + 4 * GAP_mm


def _too_wide(f: Flexspline, most: float) -> Iterator[DesignError]:
    """Which of the tube's own figures leaves no room for a flange."""
    figures = {
        "inner_diameter_mm": (f.inner_diameter_mm, most - 4 * SMALLEST_MM, 1.0),
        "wall_thickness_mm": (
            f.wall_thickness_mm,
            most - f.inner_diameter_mm - 2 * SMALLEST_MM,
            2.0,
        ),
        "ring_thickness_mm": (f.ring_thickness_mm, most - f.inner_diameter_mm, 2.0),
    }
    for key, (value, room, share) in figures.items():
        if value * share > room:
            yield fault(
                f,
                key,
                f"must be {lengths(0, room / share)} mm: for a {f.land.outer} of at most "
                f"{LENGTH_mm.high:g} mm",
            )
            return


def _thickness_faults(f: Flexspline, ceiling: float) -> Iterator[DesignError]:
    key, value = f.land.thickness, f.hole_depth
    h = f.diaphragm_thickness_mm
    if not is_step(value - h) or value >= ceiling - GAP_mm:
        room = beside(h, "diaphragm_thickness_mm", SMALLEST_MM, h, max(below(ceiling), h))
        where = (
            f"below length_mm = {f.length_mm:g}"
            if ceiling == f.length_mm
            else f"below the place z = {ceiling:g} where the ring reaches the {f.land.noun}"
        )
        yield fault(f, key, f"must be {room} mm: at least diaphragm_thickness_mm = {h:g}, {where}")
