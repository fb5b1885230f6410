"""Checks of a shaft: segments that meet, room for fillets and grip."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import accumulate, pairwise
from math import inf, sqrt

from flexspline.geometry.bounds import (
    GAP_mm,
    Interval,
    above,
    below,
    beside,
    from_zero,
    is_step,
    lengths,
    outside,
    upto,
)
from flexspline.geometry.check_bolts import bolt_faults
from flexspline.geometry.check_keyway import keyway_faults
from flexspline.geometry.errors import DesignError
from flexspline.geometry.fields import SMALLEST_MM
from flexspline.geometry.listed import joined
from flexspline.geometry.ranges import LENGTH_mm
from flexspline.geometry.shaft_shape import Shaft, ShaftSegment

STEP_mm = 2 * SMALLEST_MM
"""Of a diameter: the CAD kernel sees half of it."""


def shaft_faults(s: Shaft) -> Iterator[DesignError]:
    """Everything that keeps the shaft from being built, in the order to mend it."""
    segments = list(_segment_faults(s))
    yield from segments
    fillets = list(_fillet_faults(s))
    yield from fillets
    yield from _grip_faults(s, fillets_fit=not fillets)
    first = s.segment[0]
    yield from bolt_faults(
        "shaft.",
        s,
        ("segment[0].inner_diameter_mm", first.inner_diameter_mm),
        ("segment[0].outer_diameter_mm", first.outer_diameter_mm),
        _root(s),
    )
    if s.keyway and s.slot and not segments:
        yield from keyway_faults(s, s.keyway, s.slot.floor)


def _segment_faults(s: Shaft) -> Iterator[DesignError]:
    """Each segment by those before it: the same diameters as the one before always work."""
    for i, segment in enumerate(s.segment):
        before = s.segment[i - 1] if i else None
        around = max(t.inner_diameter_mm for t in s.segment[max(i - 1, 0) : i + 2])
        bores = sum(
            t.inner_diameter_mm >= segment.outer_diameter_mm - GAP_mm
            for t in s.segment[max(i - 1, 0) : i + 2]
        )
        if bores >= 2:  # the bores are right then, and the outside is not
            yield DesignError(
                f"shaft.segment[{i}].outer_diameter_mm",
                segment.outer_diameter_mm,
                f"must be {_outer_room(before, above(around))} mm: above inner_diameter_mm = {around:g} "
                "of this segment and the next",
            )
            return
        yield from _outer_faults(i, segment, before)
        yield from _inner_faults(i, segment, before)


def _outer_faults(
    i: int, segment: ShaftSegment, before: ShaftSegment | None
) -> Iterator[DesignError]:
    if before is None:
        return
    name, value = f"segment[{i - 1}]", segment.outer_diameter_mm
    meets = value > before.inner_diameter_mm + GAP_mm
    if meets and is_step(abs(value - before.outer_diameter_mm) / 2):
        return
    room = _outer_room(before, above(before.inner_diameter_mm))
    yield DesignError(
        f"shaft.segment[{i}].outer_diameter_mm",
        value,
        f"must be {room} mm: the same as before or a step of at least {STEP_mm:g} mm, and above "
        f"{name}.inner_diameter_mm = {before.inner_diameter_mm:g}, or the two do not meet",
    )


def _outer_room(before: ShaftSegment | None, least: float) -> str | None:
    """What an outer diameter may be, from `least` [mm], in words."""
    if before is None:
        return lengths(least, LENGTH_mm.high)
    level = before.outer_diameter_mm
    name = "outer_diameter_mm of the segment before"
    return beside(level, name, STEP_mm, max(SMALLEST_MM, least), LENGTH_mm.high)


def _inner_faults(
    i: int, segment: ShaftSegment, before: ShaftSegment | None
) -> Iterator[DesignError]:
    key, value = f"shaft.segment[{i}].inner_diameter_mm", segment.inner_diameter_mm
    most = segment.outer_diameter_mm
    if before is None:
        if value >= most - GAP_mm:
            reason = f"must be {from_zero(below(most))} mm: below outer_diameter_mm = {most:g}"
            yield DesignError(key, value, reason)
        return
    name = f"segment[{i - 1}]"
    least = min(most, before.outer_diameter_mm)
    if value < least - GAP_mm and is_step(abs(value - before.inner_diameter_mm) / 2):
        return
    room = beside(
        before.inner_diameter_mm, f"{name}.inner_diameter_mm", STEP_mm, 0.0, below(least), zero=True
    )
    yield DesignError(
        key,
        value,
        f"must be {room} mm: the same as before or a step of at least {STEP_mm:g} mm, and below "
        f"outer_diameter_mm = {most:g} and {name}.outer_diameter_mm = {before.outer_diameter_mm:g}",
    )


def _root(s: Shaft) -> float:
    """Diameter [mm] with which the second segment and its fillet stand on the first; inf where as large.

    Where the fillet is lower than SMALLEST_MM it carries nothing, and less than that of the root is none.
    """
    steps = _steps(s)
    if not steps or steps[0] > -GAP_mm:
        return inf
    f = s.fillet_mm
    thin = sqrt(SMALLEST_MM * (2 * f - SMALLEST_MM)) if f > SMALLEST_MM else f
    return s.segment[1].outer_diameter_mm + 2 * (f - thin - SMALLEST_MM)


def _steps(s: Shaft) -> list[float]:
    """Radius change from each segment to the next [mm]; 0 where there is no step."""
    return [(b.outer_diameter_mm - a.outer_diameter_mm) / 2 for a, b in pairwise(s.segment)]


def _fillet_faults(s: Shaft) -> Iterator[DesignError]:
    """One fault, of the step or segment that leaves the least room."""
    f, steps = s.fillet_mm, _steps(s)
    rooms = [
        (
            abs(step),
            f"the step from segment[{i}] to segment[{i + 1}] (outer_diameter_mm = "
            f"{s.segment[i].outer_diameter_mm:g} and {s.segment[i + 1].outer_diameter_mm:g})",
        )
        for i, step in enumerate(steps)
        if step
    ]
    for i, segment in enumerate(s.segment):
        corners = (i > 0 and steps[i - 1] < 0) + (i < len(steps) and steps[i] > 0)
        if corners:
            fits = f"to fit segment[{i}].length_mm = {segment.length_mm:g}"
            rooms.append((segment.length_mm / corners, fits))
    most, where = min(rooms, default=(LENGTH_mm.high, ""))
    if f > most + GAP_mm:
        yield DesignError("shaft.fillet_mm", f, f"must be {from_zero(upto(most))} mm: {where}")


def _grip_faults(s: Shaft, fillets_fit: bool) -> Iterator[DesignError]:
    grip, most = s.grip_length_mm, below(s.length)
    if most < SMALLEST_MM:
        yield _too_short(s)
        return
    holes = list(_fillets_along(s)) if fillets_fit else []
    # the grip ends at z = length - grip
    taken = [(s.length - high + GAP_mm / 2, s.length - low - GAP_mm / 2) for low, high in holes]
    if grip < s.length - GAP_mm and not any(low < grip < high for low, high in taken):
        return
    free = [t for a, b in outside(taken, SMALLEST_MM, most) if (t := lengths(a, b)) is not None]
    if not free:
        yield DesignError(
            "shaft.fillet_mm",
            s.fillet_mm,
            f"must be 0: fillets along the whole shaft, {s.length:g} mm, leave no grip_length_mm",
        )
        return
    where = f"below the shaft's length, {s.length:g} mm (sum of segment length_mm)"
    if taken:
        where += f", and not ending in a fillet_mm = {s.fillet_mm:g}"
    yield DesignError("shaft.grip_length_mm", grip, f"must be {joined(free, 'or')} mm: {where}")


def _fillets_along(s: Shaft) -> Iterator[Interval]:
    """(low, high) z of every fillet [mm]."""
    ends = accumulate(segment.length_mm for segment in s.segment)
    for step, z in zip(_steps(s), ends, strict=False):
        if step and s.fillet_mm > 2 * GAP_mm:
            yield (z - s.fillet_mm, z) if step > 0 else (z, z + s.fillet_mm)


def _too_short(s: Shaft) -> DesignError:
    last = len(s.segment) - 1
    least = lengths(2 * SMALLEST_MM, LENGTH_mm.high)
    return DesignError(
        f"shaft.segment[{last}].length_mm",
        s.segment[last].length_mm,
        f"must be {least} mm: for a grip and the rest of the shaft",
    )
