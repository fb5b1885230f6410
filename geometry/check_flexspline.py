"""Which flexsplines can be built: fillets that fit, a ring on the tube, holes inside their land."""

from __future__ import annotations

from collections.abc import Iterator
from math import asin, ceil, hypot, pi, sin, sqrt

from geometry.design import SMALLEST_MM, Cup, Hat, Shaft
from geometry.errors import MISSING, DesignError

TINY = 1e-6
"""Gaps below this [mm] close in the CAD kernel (its tolerance is 1e-7 mm)."""
PREFIX = "flexspline."


def flexspline_faults(f: Cup | Hat) -> Iterator[DesignError]:
    """Everything that keeps the flexspline from being built, in the order to mend it."""
    ring = list(_ring_faults(f))
    end = list(_cup_faults(f) if isinstance(f, Cup) else _hat_faults(f))
    yield from ring
    yield from end
    if not ring and not end:  # the room for fillets is only defined then
        yield from _fillet_faults(f)
    if isinstance(f, Cup):
        yield from bolt_faults(
            PREFIX,
            f,
            ("bore_diameter_mm", f.bore_diameter_mm),
            ("boss_diameter_mm", f.boss_diameter_mm),
        )
    else:
        yield from bolt_faults(
            PREFIX,
            f,
            ("flange_inner_diameter_mm", f.flange_inner_diameter_mm),
            ("flange_outer_diameter_mm", f.flange_outer_diameter_mm),
        )


def corner_wall(f: Cup | Hat) -> float:
    """Smallest wall between the inner and the outer fillet [mm]; not positive if they cross.

    With d the outer less the inner radius, wall t and diaphragm h, the arcs' centres are
    hypot(d − t, d − h) apart; the arcs come closest along the line of centres once d > t and d > h.
    """
    t, h = f.wall_thickness_mm, f.diaphragm_thickness_mm
    d = f.outer_fillet_mm - f.inner_fillet_mm
    return d - hypot(d - t, d - h) if d > max(t, h) else min(t, h)


def is_step(height: float) -> bool:
    """No step, or one that the CAD kernel sees [mm]."""
    return height == 0 or height >= SMALLEST_MM - 1e-9


def _ring_faults(f: Cup | Hat) -> Iterator[DesignError]:
    h, length = f.diaphragm_thickness_mm, f.length_mm
    rise = f.ring_thickness_mm - f.wall_thickness_mm
    if h >= length - TINY:
        yield _fault(f, "diaphragm_thickness_mm", f"must be below length_mm = {length:g}")
        return
    if not is_step(rise):
        yield _fault(
            f,
            "ring_thickness_mm",
            f"must be at least wall_thickness_mm = {f.wall_thickness_mm:g}: the same, or "
            f"{SMALLEST_MM:g} more",
        )
        return
    seat_floor, shoulder_floor = (h, 0.0) if isinstance(f, Cup) else (0.0, h)
    room = min(length - seat_floor, length - shoulder_floor - rise)
    tube = f"length_mm = {length:g} less diaphragm_thickness_mm = {h:g}"
    if room <= TINY:
        yield _fault(
            f,
            "ring_thickness_mm",
            f"must be below {f.wall_thickness_mm + length - shoulder_floor:g} mm: its 45° shoulder "
            f"rises over ring_thickness_mm - wall_thickness_mm = {rise:g} mm within {tube}",
        )
    elif f.ring_offset_mm >= room - TINY:
        yield _fault(f, "ring_offset_mm", f"must be below {room:g} ({tube}, less the shoulder)")
    elif f.ring_offset_mm + f.ring_width_mm > room + TINY:
        yield _fault(
            f,
            "ring_width_mm",
            f"must be at most {room - f.ring_offset_mm:g} mm: the ring, ring_offset_mm = "
            f"{f.ring_offset_mm:g} and a shoulder of {rise:g} mm must fit the tube ({tube})",
        )


def _cup_faults(f: Cup) -> Iterator[DesignError]:
    if f.boss_diameter_mm >= f.inner_diameter_mm - TINY:
        yield _fault(
            f, "boss_diameter_mm", f"must be below inner_diameter_mm = {f.inner_diameter_mm:g}"
        )
    if f.bore_diameter_mm >= f.boss_diameter_mm - TINY:
        yield _fault(
            f,
            "bore_diameter_mm",
            f"must be from 0 to below boss_diameter_mm = {f.boss_diameter_mm:g}",
        )
    yield from _thickness_faults(f, "boss_thickness_mm", f.boss_thickness_mm)


def _hat_faults(f: Hat) -> Iterator[DesignError]:
    inner, outer = f.flange_inner_diameter_mm, f.flange_outer_diameter_mm
    if inner <= 2 * f.wall_radius + TINY:
        yield _fault(
            f,
            "flange_inner_diameter_mm",
            f"must be above the tube's outside, inner_diameter_mm + 2 wall_thickness_mm = "
            f"{2 * f.wall_radius:g}",
        )
    if outer <= inner + TINY:
        yield _fault(
            f, "flange_outer_diameter_mm", f"must be above flange_inner_diameter_mm = {inner:g}"
        )
    yield from _thickness_faults(f, "flange_thickness_mm", f.flange_thickness_mm)
    # a flange taller than the shoulder must leave room for the ring inside it
    touches = f.ring_start - max(0.0, f.ring_radius - inner / 2)
    if inner / 2 <= f.ring_radius + TINY and f.flange_thickness_mm > touches - TINY:
        yield _fault(
            f,
            "flange_thickness_mm",
            f"must be below {touches:g} mm, where the ring reaches flange_inner_diameter_mm = "
            f"{inner:g}",
        )


def _thickness_faults(f: Cup | Hat, key: str, value: float) -> Iterator[DesignError]:
    h, length = f.diaphragm_thickness_mm, f.length_mm
    if not is_step(value - h) or value >= length - TINY:
        yield _fault(
            f,
            key,
            f"must be at least diaphragm_thickness_mm = {h:g} (the same, or {SMALLEST_MM:g} more) "
            f"and below length_mm = {length:g}",
        )


def _fillet_faults(f: Cup | Hat) -> Iterator[DesignError]:
    h, start = f.diaphragm_thickness_mm, f.ring_start
    if isinstance(f, Cup):
        end, boss = f"boss_diameter_mm = {f.boss_diameter_mm:g}", f.boss_diameter_mm / 2
        inner_radial, outer_radial = f.inner_radius - boss, f.wall_radius - boss
        inner_axial, outer_axial = start - h, f.shoulder_start
    else:
        flange = f.flange_inner_diameter_mm / 2
        end = f"flange_inner_diameter_mm = {f.flange_inner_diameter_mm:g}"
        inner_radial, outer_radial = flange - f.wall_radius, flange - f.inner_radius
        inner_axial, outer_axial = f.shoulder_start - h, start
    fits = True
    for key, radial, axial in (
        ("inner_fillet_mm", inner_radial, inner_axial),
        ("outer_fillet_mm", outer_radial, outer_axial),
    ):
        if getattr(f, key) > min(radial, axial) + TINY:
            fits = False
            where = f"between the tube and {end}" if radial <= axial else "below the toothed ring"
            yield _fault(f, key, f"must be from 0 to {min(radial, axial):g} mm to fit {where}")
    if fits and corner_wall(f) <= TINY:
        t = f.wall_thickness_mm
        limit = f.inner_fillet_mm + t + h + sqrt(2 * t * h)
        yield _fault(
            f,
            "outer_fillet_mm",
            f"must be below {limit:.4g} mm or it cuts through to inner_fillet_mm = "
            f"{f.inner_fillet_mm:g} (wall_thickness_mm = {t:g}, diaphragm_thickness_mm = {h:g})",
        )


def bolt_faults(
    prefix: str, part: Cup | Hat | Shaft, inner: tuple[str, float], outer: tuple[str, float]
) -> Iterator[DesignError]:
    """Holes that leave the ring between two diameters (key, mm), or touch each other."""
    n, circle, hole = part.bolt_count, part.bolt_circle_diameter_mm, part.bolt_hole_diameter_mm
    if n == 0:
        return
    land = f"{inner[0]} = {inner[1]:g} and {outer[0]} = {outer[1]:g}"
    alone = n == 1 and inner[1] == 0  # a single hole in a solid end may lie over the axis
    largest = outer[1] if alone else (outer[1] - inner[1]) / 2
    if hole is None:
        yield DesignError(
            prefix + "bolt_hole_diameter_mm",
            MISSING,
            f"bolt_count = {n} needs it; give a number of mm below {largest:g} ({land})",
        )
    if circle is None:
        yield DesignError(
            prefix + "bolt_circle_diameter_mm",
            MISSING,
            f"bolt_count = {n} needs it; give a number of mm between {inner[1]:g} and {outer[1]:g} "
            f"({land})",
        )
    if hole is None or circle is None or outer[1] <= inner[1]:
        return
    if hole >= largest - TINY:
        yield DesignError(
            prefix + "bolt_hole_diameter_mm",
            hole,
            f"must be below {largest:g} mm to fit between {land}",
        )
        return
    low, high = 0.0 if alone else inner[1] + hole, outer[1] - hole
    if not low + TINY < circle < high - TINY and not (alone and circle < high - TINY):
        yield DesignError(
            prefix + "bolt_circle_diameter_mm",
            circle,
            f"must be between {low:g} and {high:g} mm so that holes of bolt_hole_diameter_mm = "
            f"{hole:g} stay between {land}",
        )
    elif n >= 2 and circle * sin(pi / n) <= hole + TINY:
        yield DesignError(
            prefix + "bolt_count",
            n,
            f"must be from 0 to {_most_holes(circle, hole)} or the holes touch, or "
            f"bolt_hole_diameter_mm = {hole:g} below {circle * sin(pi / n):.4g} mm "
            f"(bolt_circle_diameter_mm = {circle:g})",
        )


def _most_holes(circle: float, hole: float) -> int:
    """The largest number of equal holes on a circle that do not touch."""
    if hole + TINY >= circle:
        return 1
    return max(1, ceil(pi / asin((hole + TINY) / circle)) - 1)


def _fault(f: Cup | Hat, key: str, reason: str) -> DesignError:
    return DesignError(PREFIX + key, getattr(f, key), reason)
