"""Which shafts can be built: segments that meet, fillets, grip and keyway with room."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import accumulate, pairwise
from math import sqrt

from geometry.check_flexspline import TINY, bolt_faults, is_step
from geometry.design import SMALLEST_MM, Keyway, Shaft
from geometry.errors import DesignError


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
    )
    if s.keyway and not segments:
        yield from _keyway_faults(s, s.keyway)


def _segment_faults(s: Shaft) -> Iterator[DesignError]:
    for i, a in enumerate(s.segment):
        if a.inner_diameter_mm >= a.outer_diameter_mm - TINY:
            yield DesignError(
                f"shaft.segment[{i}].inner_diameter_mm",
                a.inner_diameter_mm,
                f"must be from 0 to below outer_diameter_mm = {a.outer_diameter_mm:g}",
            )
    for i, (a, b) in enumerate(pairwise(s.segment)):
        for j, k, bored, solid in ((i, i + 1, a, b), (i + 1, i, b, a)):
            if solid.outer_diameter_mm <= bored.inner_diameter_mm + TINY:
                yield DesignError(
                    f"shaft.segment[{k}].outer_diameter_mm",
                    solid.outer_diameter_mm,
                    f"must be above segment[{j}].inner_diameter_mm = {bored.inner_diameter_mm:g}, "
                    "or the two segments do not meet",
                )
        for key in ("outer_diameter_mm", "inner_diameter_mm"):
            below, above = getattr(a, key), getattr(b, key)
            if not is_step(abs(above - below) / 2):
                yield DesignError(
                    f"shaft.segment[{i + 1}].{key}",
                    above,
                    f"must equal segment[{i}].{key} = {below:g} or differ by at least "
                    f"{2 * SMALLEST_MM:g} mm",
                )


def _steps(s: Shaft) -> list[float]:
    """Radius change from each segment to the next [mm]; 0 where there is no step."""
    return [(b.outer_diameter_mm - a.outer_diameter_mm) / 2 for a, b in pairwise(s.segment)]


def _fillet_faults(s: Shaft) -> Iterator[DesignError]:
    f, steps = s.fillet_mm, _steps(s)
    for i, step in enumerate(steps):
        if step and f > abs(step) + TINY:
            yield DesignError(
                "shaft.fillet_mm",
                f,
                f"must be from 0 to {abs(step):g} mm, the step from segment[{i}] to "
                f"segment[{i + 1}] (outer_diameter_mm = {s.segment[i].outer_diameter_mm:g} and "
                f"{s.segment[i + 1].outer_diameter_mm:g})",
            )
    for i, segment in enumerate(s.segment):
        corners = (i > 0 and steps[i - 1] < 0) + (i < len(steps) and steps[i] > 0)
        if corners * f > segment.length_mm + TINY:
            yield DesignError(
                "shaft.fillet_mm",
                f,
                f"must be from 0 to {segment.length_mm / corners:g} mm to fit "
                f"segment[{i}].length_mm = {segment.length_mm:g}",
            )


def _grip_faults(s: Shaft, fillets_fit: bool) -> Iterator[DesignError]:
    grip = s.grip_length_mm
    if grip >= s.length - TINY:
        yield DesignError(
            "shaft.grip_length_mm",
            grip,
            f"must be below the shaft's length, {s.length:g} mm (sum of segment length_mm)",
        )
        return
    if not fillets_fit:
        return
    start = s.length - grip
    ends = accumulate(segment.length_mm for segment in s.segment)
    for i, (step, z) in enumerate(zip(_steps(s), ends, strict=False)):
        low, high = (z - s.fillet_mm, z) if step > 0 else (z, z + s.fillet_mm)
        if step and low + TINY < start < high - TINY:
            yield DesignError(
                "shaft.grip_length_mm",
                grip,
                f"must be at most {s.length - high:g} or at least {s.length - low:g} mm, so that "
                f"it does not end in the fillet_mm = {s.fillet_mm:g} between segment[{i}] and "
                f"segment[{i + 1}]",
            )


def _keyway_faults(s: Shaft, key: Keyway) -> Iterator[DesignError]:
    last = s.segment[-1]
    radius = last.outer_diameter_mm / 2
    floor = radius - key.depth_mm
    if key.length_mm >= s.length - TINY:
        yield DesignError(
            "shaft.keyway.length_mm",
            key.length_mm,
            f"must be below the shaft's length, {s.length:g} mm (sum of segment length_mm)",
        )
    bored = [
        (segment.inner_diameter_mm / 2, i)
        for i, segment in enumerate(s.segment)
        if sum(t.length_mm for t in s.segment[: i + 1]) > s.length - key.length_mm + TINY
        and segment.outer_diameter_mm / 2 > floor
    ]
    bore, i = max(bored, default=(last.inner_diameter_mm / 2, len(s.segment) - 1))
    if floor <= bore + TINY:
        yield DesignError(
            "shaft.keyway.depth_mm",
            key.depth_mm,
            f"must be below {radius - bore:g} mm, from the last outer_diameter_mm = {2 * radius:g} "
            f"to segment[{i}].inner_diameter_mm = {2 * bore:g}",
        )
        return
    chord = 2 * sqrt(radius**2 - floor**2)
    if key.width_mm >= chord - TINY:
        yield DesignError(
            "shaft.keyway.width_mm",
            key.width_mm,
            f"must be below {chord:.4g} mm, the chord at depth_mm = {key.depth_mm:g} in "
            f"outer_diameter_mm = {2 * radius:g}",
        )
