"""The peak stress on the wave generator's ellipse, from the meridian or from the solid model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.axisymmetric.stress import ellipse_stress
from flexspline.fea.deadline import Deadline
from flexspline.fea.shortfall import missing_because
from flexspline.fea.types import Shortfall, SolidField, StressPeak
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.meridian import with_narrow_seat
from flexspline.geometry.outline import Meridian
from flexspline.pipeline.by_harmonics import by_harmonics
from flexspline.pipeline.enclosed_part import may_answer
from flexspline.pipeline.parts import PartModel
from flexspline.pipeline.peak_with_holes import (
    BodyLoad,
    body_peak,
    peak_by_two_bodies,
    peak_tolerance,
)
from flexspline.pipeline.superposed_ellipse import superposed_ellipse
from flexspline.pipeline.wave_generator import coarse_ellipse, solid_ellipse

NARROW_SEAT = 0.5
"""Share of the ring's width that the seat has where it is asked how its width matters."""
SEAT_TOLERANCE = 0.02
"""Change of that peak over two refinements: it says how much the width matters, by 5 to 30 %."""
ONE_MESH_ERROR = 0.015
"""Of the solid model's peak: what its mesh leaves without holes, where it is usual. Of nine cups and hats
with holes four had 1.5 to 7 % more, and five came within 1.4 %."""
ONE_MESH = "it is of one mesh, on which such peaks were up to 7 % off"


def ellipse_peak(flexspline: PartModel) -> StressPeak:
    """Return the peak stress on the wave generator's ellipse, by the model that the part's stiffness uses.

    Where the solid model is needed for the stress at the holes alone, and fails, the peak is that without
    holes, and its `shortfall` says so.

    Raises
    ------
    DesignError
    ComputationError, MemoryError : the solve failed.
    """
    if flexspline.axisymmetric:
        return body_peak(flexspline, _load(flexspline))
    agreed = _by_two_bodies(flexspline)
    if agreed is not None and agreed.stands_for:
        return agreed
    try:
        return _with_holes(flexspline).peak
    except (ComputationError, MemoryError) as fault:
        if agreed is None:
            raise
        why = missing_because(fault)
        words = f"the stress at the bolt holes is not known: {why.words}"
        return replace(agreed, shortfall=replace(why, words=words))


def ellipse_field(flexspline: PartModel) -> SolidField:
    """Return the field for pictures and files, with the peak of the model that answers. Errors as
    `ellipse_peak`."""
    if flexspline.axisymmetric:
        return replace(coarse_ellipse(flexspline), peak=ellipse_peak(flexspline))
    agreed = _by_two_bodies(flexspline)
    if agreed is not None and agreed.stands_for:
        return replace(coarse_ellipse(flexspline), peak=agreed)
    return _with_holes(flexspline)


def _with_holes(flexspline: PartModel) -> SolidField:
    """The field of the part itself: superposed, or the solid model's where that is asked for by name."""
    if flexspline.part.bolts is None:
        return solid_ellipse(flexspline)
    try:
        superposed = superposed_ellipse(flexspline)
    except ComputationError as fault:
        why = Shortfall(f"{ONE_MESH}, and there is no other peak to compare: {fault}")
        return _doubted(solid_ellipse(flexspline), why)
    if may_answer(flexspline):
        return superposed
    solid, known = solid_ellipse(flexspline), superposed.peak.mises_MPa
    if abs(solid.peak.mises_MPa / known - 1) <= ONE_MESH_ERROR:
        return solid
    other = f"the field without holes, plus what these change, has {known:.4g} MPa"
    return _doubted(solid, Shortfall(f"{ONE_MESH}, and {other}"))


def _doubted(field: SolidField, why: Shortfall) -> SolidField:
    """With that reason, unless it has one already."""
    return replace(field, peak=replace(field.peak, shortfall=field.peak.shortfall or why))


def half_seat_peak(flexspline: PartModel) -> StressPeak:
    """Return the ellipse's peak on a seat half as wide, without holes.

    How wide the bearing that carries the seat is, no design states: the seat is taken as wide as the ring.
    """
    return _without_holes(
        flexspline,
        "half_seat_peak",
        "wave generator, seat half as wide,",
        lambda outline: with_narrow_seat(outline, NARROW_SEAT),
    )


def full_seat_peak(flexspline: PartModel) -> StressPeak:
    """Return the ellipse's peak on the seat as wide as the ring, without holes, as `half_seat_peak` is.

    `ellipse_peak` of a part with holes may be the solid model's, which differs from the meridian's by more
    than the seat's width does.
    """
    return _without_holes(
        flexspline,
        "full_seat_peak",
        "wave generator, bolt holes left out,",
        lambda outline: outline,
    )


def _without_holes(
    flexspline: PartModel, figure: str, title: str, seated: Callable[[Meridian], Meridian]
) -> StressPeak:
    w0, exclusion_mm = flexspline.context.design.w0_mm, flexspline.part.exclusion_mm

    def make(outline: Meridian, deadline: Deadline) -> StressPeak:
        material, seat = flexspline.material, seated(outline)
        return ellipse_stress(seat, material, w0, exclusion_mm, SEAT_TOLERANCE, deadline).peak

    return by_harmonics(flexspline, figure, title, make, w0_mm=w0)


def _by_two_bodies(flexspline: PartModel) -> StressPeak | None:
    """As `peak_by_two_bodies`."""
    coarse = partial(coarse_ellipse, flexspline)
    return peak_by_two_bodies(flexspline, _load(flexspline), coarse)


def _load(flexspline: PartModel) -> BodyLoad:
    w0, exclusion_mm = flexspline.context.design.w0_mm, flexspline.part.exclusion_mm
    material, tolerance = flexspline.material, peak_tolerance(flexspline.tolerance)

    def solve(outline: Meridian, deadline: Deadline) -> RevolvedField:
        return ellipse_stress(outline, material, w0, exclusion_mm, tolerance, deadline)

    return BodyLoad("wave_generator_peak", "wave generator", solve, {"w0_mm": w0})
