"""Checks of bolt holes: inside their land, apart from each other."""

from __future__ import annotations

from collections.abc import Iterator
from math import asin, ceil, inf, pi

from flexspline.geometry.bolts import pitch
from flexspline.geometry.bounds import GAP_mm, above, below, lengths
from flexspline.geometry.errors import MISSING, DesignError
from flexspline.geometry.fields import SMALLEST_MM
from flexspline.geometry.shaft_shape import Shaft
from flexspline.geometry.shapes import Flexspline


def bolt_faults(
    prefix: str,
    part: Flexspline | Shaft,
    inner: tuple[str, float],
    outer: tuple[str, float],
    root: float = inf,
) -> Iterator[DesignError]:
    """Holes that leave the ring between two diameters (key, mm), touch each other, or cut the part in two.

    `root`: diameter [mm] of the circle about the axis that a single hole may not hold as a whole, for what
    stands on it would be cut off.
    """
    n, circle, hole = part.bolt_count, part.bolt_circle_diameter_mm, part.bolt_hole_diameter_mm
    if n == 0 or outer[1] <= inner[1]:
        return
    land = f"{inner[0]} = {inner[1]:g} and {outer[0]} = {outer[1]:g}"
    alone = n == 1 and inner[1] == 0  # a single hole in a solid end may lie over the axis
    largest = min(outer[1], (outer[1] + root) / 2) if alone else (outer[1] - inner[1]) / 2
    cut_off = "" if root == inf or not alone else " and do not cut off the next segment"
    most = largest - 4 * GAP_mm - (SMALLEST_MM if alone else 0.0)
    holes = lengths(0, most)  # a little less than fits: a circle must be left to put them on
    if holes is None:
        yield DesignError(
            prefix + "bolt_count",
            n,
            f"must be 0: between {land} no hole has room; to have some, change one of the two",
        )
        return
    if hole is None or hole > most:
        if circle is not None and (
            on_circle := _room_on(circle, n, inner[1], outer[1], alone, root)
        ):
            holes, land = on_circle, f"{land} on bolt_circle_diameter_mm = {circle:g}"
        reason = f"{holes} mm to fit between {land}{cut_off}"
        yield _refused(prefix + "bolt_hole_diameter_mm", hole, n, reason)
        return
    low = max(0.0, hole - root) if alone else above(inner[1] + hole)
    high = below(outer[1] - hole)
    if circle is None or not low - GAP_mm < circle < high + GAP_mm:
        reason = (
            f"{lengths(low, high)} mm so that holes of bolt_hole_diameter_mm = {hole:g} stay between "
            f"{land}{cut_off}"
        )
        yield _refused(prefix + "bolt_circle_diameter_mm", circle, n, reason)
    elif pitch(circle, n) <= hole + GAP_mm:
        smaller = lengths(0, below(pitch(circle, n)), 4)
        also = f"; {n} holes take a diameter {smaller} mm" if smaller else ""
        yield DesignError(
            prefix + "bolt_count",
            n,
            f"must be from 0 to {_most_holes(circle, hole)}: beyond, holes of bolt_hole_diameter_mm = "
            f"{hole:g} touch on bolt_circle_diameter_mm = {circle:g}{also}",
        )


def _refused(key: str, value: float | None, count: int, reason: str) -> DesignError:
    """A diameter that is missing or does not fit; `reason` begins with those that do."""
    if value is None:
        return DesignError(key, MISSING, f"bolt_count = {count} needs it; give a number {reason}")
    return DesignError(key, value, f"must be {reason}")


def _room_on(
    circle: float, count: int, inner: float, outer: float, alone: bool, root: float
) -> str | None:
    """Diameters of holes that fit on a circle; None where it leaves no room for any."""
    inside = min(outer, circle + root) if alone else circle - inner
    return lengths(0, below(min(inside, outer - circle, pitch(circle, count))))


def _most_holes(circle: float, hole: float) -> int:
    """The largest number of equal holes on a circle that do not touch."""
    if hole + GAP_mm >= circle:
        return 1
    return max(1, ceil(pi / asin((hole + GAP_mm) / circle)) - 1)
