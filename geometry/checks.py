"""Checks that use several keys of a design: impossible geometry is refused, with numbers.

What one key may hold by itself stands in `geometry.design`. What can be built but looks wrong is a
warning of `geometry.sanity`, never a refusal.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator
from functools import partial
from math import cos, radians

from flexspline.geometry.bounds import below, last_that, span
from flexspline.geometry.check_flexspline import flexspline_faults
from flexspline.geometry.check_shaft import shaft_faults
from flexspline.geometry.check_tooth import least_module_mm, ring_ends, tooth_faults
from flexspline.geometry.circular_spline import circular_spline_faults
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.fields import UM_PER_MM
from flexspline.geometry.module_fit import (
    MM_PER_M,
    fitting_diameters_mm,
    fitting_module_mm,
    fitting_modules_mm,
    looks_like_metres,
    module_hint,
    with_fitting_module,
)
from flexspline.geometry.play_limit import beyond_play_limit
from flexspline.geometry.ranges import TEETH, LENGTH_mm
from flexspline.geometry.rated import rated_faults
from flexspline.geometry.wave_generator import wave_generator_faults

RANGE_SHARE = 1e-6
"""Error of a range's end, as a share of the range: ends are told in four digits."""


def check(design: Design) -> None:
    """Refuse an impossible design.

    Raises
    ------
    DesignError : the first fault: its key, its value, the range that works; and the others.
    """
    faults = list(_faults(design))
    if faults:
        first = faults[0]
        raise DesignError(first.key, first.value, first.reason, faults[1:])


def _faults(design: Design) -> Iterator[DesignError]:
    yield from _name_faults(design)
    yield from flexspline_faults(design.flexspline, ring_ends(design))
    yield from shaft_faults(design.shaft)
    yield from _gear_faults(design)
    yield from _diameter_faults(design)
    yield from _module_faults(design)
    yield from tooth_faults(design)
    yield from wave_generator_faults(design)
    yield from circular_spline_faults(design)
    yield from _solver_faults(design)


def _name_faults(design: Design) -> Iterator[DesignError]:
    names = {
        f"material.{key}.name": material.name for key, material in design.material.stated.items()
    }
    names["name"] = design.name
    for key, text in names.items():
        if any(unicodedata.category(c) in ("Cc", "Cs", "Zl", "Zp") for c in text):
            yield DesignError(key, text, "must be one line of text without control characters")
        elif not text.strip():
            yield DesignError(key, text, "must hold 1 to 200 characters that are not blank")


def _gear_faults(design: Design) -> Iterator[DesignError]:
    z1, z2 = design.gear.teeth_flexspline, design.gear.teeth_circular_spline
    if z1 + 2 > TEETH.high:
        yield DesignError(
            "gear.teeth_flexspline",
            z1,
            f"must be from {TEETH.low:g} to {TEETH.high - 2:g}: the circular spline has at least two more",
        )
    elif z2 <= z1 or (z2 - z1) % 2:
        yield DesignError(
            "gear.teeth_circular_spline",
            z2,
            f"must be {', '.join(str(n) for n in (z1 + 2, z1 + 4) if n <= TEETH.high)}, …: "
            f"teeth_flexspline = {z1} plus an even number for the two lobes",
        )


def _by_module(design: Design) -> Iterator[DesignError]:
    """Of values whose range follows from the module."""
    yield from _clearance_faults(design)
    yield from _play_faults(design)
    yield from rated_faults(design)


def _module_faults(design: Design) -> Iterator[DesignError]:
    """Where the module refuses a value, but the ring asks for another module, the module is wrong first, and
    the values are judged by that of the ring."""
    refused = next(_by_module(design), None)
    if refused is None:
        return
    judged = with_fitting_module(design)
    if judged is not design:
        low, high = fitting_modules_mm(design)
        low = max(low, least_module_mm(design))
        yield DesignError(
            "gear.module_mm",
            design.gear.module_mm,
            f"must be {span(low, high, 3)} mm with {design.gear.teeth_flexspline} teeth on a ring of "
            f"{2 * design.flexspline.ring_radius:.4g} mm, some {fitting_module_mm(design):.2g}; else no "
            f"gear of that size has {refused.key} = {refused.value:g}",
        )
    yield from _by_module(judged)


def _diameter_faults(design: Design) -> Iterator[DesignError]:
    """A diameter of 0.04 mm that is built takes a minute and ends in figures of nothing."""
    inner_mm, stroke = design.flexspline.inner_diameter_mm, design.w0_mm
    metres = looks_like_metres(design)
    low, high = fitting_diameters_mm(design)
    low = max(low, 2 * stroke)
    if not metres and (
        inner_mm > 2 * stroke or not module_hint(design) or not _may_have(design, low)
    ):
        return
    room = span(low, _largest_allowed(design, low, high), 4)
    if room is None:  # module or teeth are wrong
        return
    why = (
        f"it looks like metres: {MM_PER_M * inner_mm:g} mm"
        if metres
        else f"the wave generator's stroke of {stroke:.4g} mm is no less than the tube's radius"
    )
    yield DesignError(
        "flexspline.inner_diameter_mm",
        inner_mm,
        f"must be {room} mm, which module and teeth fit; {why}",
    )


def _may_have(design: Design, inner_mm: float) -> bool:
    """Whether the rest of the flexspline allows an inner diameter; where not, the module is wrong."""
    part = design.flexspline.model_copy(update={"inner_diameter_mm": inner_mm})
    other = design.model_copy(update={"flexspline": part})
    return inner_mm <= LENGTH_mm.high and not any(flexspline_faults(part, ring_ends(other)))


def _largest_allowed(design: Design, low: float, high: float) -> float:
    """The largest inner diameter up to `high` that `_may_have` [mm]; `high` where it has not even `low`."""
    if low > high or _may_have(design, high) or not _may_have(design, low):
        return high
    return last_that(partial(_may_have, design), low, high, RANGE_SHARE * (high - low))


def _clearance_faults(design: Design) -> Iterator[DesignError]:
    """A tooth is half the pitch thick; what a space is wider takes the circular spline's teeth away."""
    gear = design.gear
    thick = UM_PER_MM * gear.tooth_thickness_mm
    limit = thick * cos(radians(gear.pressure_angle_deg))
    if gear.flank_clearance_um >= limit:
        yield DesignError(
            "gear.flank_clearance_um",
            gear.flank_clearance_um,
            f"must be {span(0.0, below(limit), 4)} µm: a tooth is {thick:.4g} µm thick, and beyond nothing "
            "of the circular spline's teeth is left to carry a torque",
        )


def _play_faults(design: Design) -> Iterator[DesignError]:
    gear, bearing = design.gear, design.bearing
    if bearing.bearing_play_model != "involute" or gear.centre_distance_mm <= 0:
        return
    c, limit = bearing.radial_clearance_um, gear.bearing_play_limit_um
    if beyond_play_limit(c, limit):
        yield DesignError(
            "bearing.radial_clearance_um",
            c,
            f"must be {span(0.0, limit, 4)} µm, c_max = 2a(1 - cos α), where the involute model "
            'ends; bearing_play_model = "small_displacement" has no such end',
        )


def _solver_faults(design: Design) -> Iterator[DesignError]:
    if design.solver.model != "axisymmetric":
        return
    holes = design.flexspline.bolt_count or design.shaft.bolt_count
    if holes or design.shaft.keyway:
        what = f"bolt_count = {holes} makes holes" if holes else "shaft.keyway is cut"
        yield DesignError(
            "solver.model",
            design.solver.model,
            f'must be "solid" or "auto": {what}, and the part is not a body of revolution',
        )
