"""Warnings of a result: unusual values in the design, missed tolerances, missing figures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from flexspline.pipeline.stress_limits import ON_ELLIPSE, ON_HALF_SEAT, PEAK_OF, limits_passed
from flexspline.results.gear_words import gear_warnings
from flexspline.results.limit_words import load_beyond, passed_line
from flexspline.results.numbers import beyond
from flexspline.results.quantities import quantity

if TYPE_CHECKING:
    from flexspline.fea.types import SolidField, StressPeak
    from flexspline.geometry.design import Design
    from flexspline.pipeline.analysis import RunResult
    from flexspline.pipeline.stiffnesses import Stiffnesses

PEAK_KEYS = {
    **{case: f"{peak}_mises_MPa" for case, peak in PEAK_OF.items()},
    ON_ELLIPSE: f"{ON_ELLIPSE}_mises_MPa",
    "half_seat_peak": f"{ON_HALF_SEAT}_mises_MPa",
    "full_seat_peak": f"{ON_HALF_SEAT}_mises_MPa",
}
"""Keys in result.json of peak stresses, by the names under which they are solved; all else is a stiffness."""


def shortfalls(
    design: Design, stiffnesses: Stiffnesses, fields: Mapping[str, SolidField] | None = None
) -> tuple[str, ...]:
    """One line for each figure that passes a limit, whose bounds are wider than asked for, that is known to
    be off by more than they say, or that is missing, and why."""
    peaks = _peaks(stiffnesses, fields or {})
    return (
        *map(passed_line, limits_passed(design, peaks)),
        *_wide(design, stiffnesses),
        *_beyond_bounds(design, stiffnesses),
        *_unsettled(peaks),
        *_left_out(peaks),
        *_missing(stiffnesses),
    )


def all_warnings(result: RunResult) -> tuple[str, ...]:
    """Of a run: the design's own, then those of the figures."""
    return (*result.warnings, *solved_warnings(result))


def solved_warnings(result: RunResult) -> tuple[str, ...]:
    """Of a run's figures."""
    return (
        *load_beyond(result.linear_limit, result.design),
        *shortfalls(result.design, result.stiffnesses, result.fields),
        *(f"whole gear: {line}" for line in (gear_warnings(result.gear) if result.gear else ())),
    )


def _peaks(stiffnesses: Stiffnesses, fields: Mapping[str, SolidField]) -> dict[str, StressPeak]:
    """By their names in result.json."""
    peaks = {PEAK_OF[name]: solved.peak for name, solved in fields.items()}
    if stiffnesses.wave_generator_peak is not None:
        peaks["wave_generator_peak"] = stiffnesses.wave_generator_peak
    return peaks


def _wide(design: Design, stiffnesses: Stiffnesses) -> Iterator[str]:
    tolerance_pct = design.solver.tolerance_pct
    for name, stiffness in stiffnesses.solved.items():
        half = 100 * stiffness.half_width
        if half > tolerance_pct:
            symbol = quantity(f"{name}_Nm_per_rad").symbol
            yield (
                f"{symbol} is known to ± {beyond(half, tolerance_pct)} %, wider than the requested "
                f"± {tolerance_pct:g} % (solver.tolerance_pct)"
                + (f": {stiffness.shortfall}" if stiffness.shortfall else "")
            )


def _beyond_bounds(design: Design, stiffnesses: Stiffnesses) -> tuple[str, ...]:
    from flexspline.pipeline.first_face import too_large_lines

    return too_large_lines(design) if "K_e" in stiffnesses.solved else ()


def _unsettled(peaks: Mapping[str, StressPeak]) -> Iterator[str]:
    for name, peak in peaks.items():
        if peak.shortfall:
            title = quantity(f"{name}_mises_MPa").name
            yield f"{title}: may still change with a finer mesh, {peak.shortfall}"


def _left_out(peaks: Mapping[str, StressPeak]) -> Iterator[str]:
    for name, peak in peaks.items():
        if peak.left_out:
            title = quantity(f"{name}_mises_MPa").name
            yield f"{title}: the mesh leaves out {peak.left_out}, where the stress is higher"


def _missing(stiffnesses: Stiffnesses) -> Iterator[str]:
    written = set()
    for name, why in stiffnesses.missing.items():
        if name == "gear":
            yield f"Whole gear: not computed, {why}"
            continue
        key = PEAK_KEYS.get(name, f"{name}_Nm_per_rad")
        if key in written:  # a field and its peak fail together
            continue
        written.add(key)
        yield f"{quantity(key).name}: not computed, {why}"
