"""Checks of a flexspline's fillets: beside the boss or flange, below the ring, apart from each other."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot, inf, sqrt

from flexspline.geometry.bounds import GAP_mm, from_zero, lengths, upto
from flexspline.geometry.errors import DesignError
from flexspline.geometry.ranges import LENGTH_mm
from flexspline.geometry.shapes import Flexspline

PREFIX = "flexspline."


def fault(f: Flexspline, key: str, reason: str) -> DesignError:
    """A fault of a key of the flexspline, with the value that it has."""
    return DesignError(PREFIX + key, getattr(f, key), reason)


def corner_wall(f: Flexspline) -> float:
    """Smallest wall between the inner and the outer fillet [mm]; not positive if they cross.

    With d the outer less the inner radius, wall t and diaphragm h, the arcs' centres are
    hypot(d − t, d − h) apart; the arcs come closest along the line of centres once d > t and d > h.
    """
    t, h = f.wall_thickness_mm, f.diaphragm_thickness_mm
    d = f.outer_fillet_mm - f.inner_fillet_mm
    return d - hypot(d - t, d - h) if d > max(t, h) else min(t, h)


def fillet_faults(f: Flexspline) -> Iterator[DesignError]:
    """The first fillet without room; what the ring and the closed end leave must be sound already."""
    h, start, t = f.diaphragm_thickness_mm, f.ring_start, f.wall_thickness_mm
    key, edge = f.land_edge, f.size(f.land_edge) / 2
    if f.inward:
        inner_radial, outer_radial = f.inner_radius - edge, f.wall_radius - edge
        inner_axial, outer_axial = start - h, f.shoulder_start
    else:
        inner_radial, outer_radial = edge - f.wall_radius, edge - f.inner_radius
        inner_axial, outer_axial = f.shoulder_start - h, start
    end = f"{key} = {f.size(key):g}"
    over = sqrt(2 * t * h)
    # less what leaves a wall of GAP_mm: it shrinks by over / (over + t + h) of the fillet's growth
    through = f.inner_fillet_mm + (t + h + over) * (1 - 2 * GAP_mm / over)
    for name, radial, axial, limit in (
        ("inner_fillet_mm", inner_radial, inner_axial, inf),
        ("outer_fillet_mm", outer_radial, outer_axial, through),
    ):
        most = max(min(radial, axial), 0.0)
        value = getattr(f, name)
        cuts = limit < inf and corner_wall(f) <= GAP_mm
        if value <= most + GAP_mm and not cuts:
            continue
        room = from_zero(min(upto(most), limit))
        if cuts and limit < most:
            reason = (
                f"must be {room} mm or it cuts through to inner_fillet_mm = {f.inner_fillet_mm:g} "
                f"(wall_thickness_mm = {t:g}, diaphragm_thickness_mm = {h:g})"
            )
        else:
            where = f"between the tube and {end}" if radial <= axial else "below the toothed ring"
            reason = f"must be {room} mm to fit {where}"
            if room == "0":
                room_maker = _room_maker(f, value - most, radial <= axial, key)
                reason += f": to have one, change {room_maker}"
        yield fault(f, name, reason)
        return


def _room_maker(f: Flexspline, lacking: float, radial: bool, key: str) -> str:
    """Which key gives a fillet its room, and how far it must go."""
    if radial and not f.inward:
        least = lengths(f.size(key) + 2 * lacking, LENGTH_mm.high)
        return f"{PREFIX}{key} to {least.split(' ')[1]} mm or more" if least else f"{PREFIX}{key}"
    names = (key,) if radial else ("ring_width_mm", "ring_offset_mm")
    for name in names:
        room = lengths(0, getattr(f, name) - (2 if radial else 1) * lacking)
        if room is not None:
            return f"{PREFIX}{name} to {room.rpartition(' ')[2]} mm or less"
    return f"{PREFIX}{'inner_diameter_mm' if radial else 'length_mm'}"
