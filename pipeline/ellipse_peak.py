"""The peak stress on the wave generator's ellipse, from the meridian or from the solid model.

A flexspline with bolt holes lies between two bodies of revolution (`geometry.nested`). No theorem orders
their stresses, but what the ellipse does to the rim dies out towards the holes: where both bodies have the
same peak at the same place, and the stress about the holes is below it, the holes do not matter to it.
"""

from __future__ import annotations

from dataclasses import replace
from math import dist, inf, pi

import numpy as np

from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.axisymmetric.stress import ellipse_stress
from flexspline.fea.deadline import Deadline
from flexspline.fea.shortfall import missing_because
from flexspline.fea.types import SolidField, StressPeak
from flexspline.geometry.bolts import BoltCircle
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.meridian import with_narrow_seat
from flexspline.geometry.nested import nested_bodies
from flexspline.geometry.outline import Meridian
from flexspline.geometry.part import Part
from flexspline.pipeline.by_harmonics import by_harmonics
from flexspline.pipeline.enclosed_part import may_answer
from flexspline.pipeline.parts import PartModel
from flexspline.pipeline.wave_generator import coarse_ellipse, solid_ellipse

PEAK_STRESS_TOLERANCE = 0.005
"""Change of a peak stress over two refinements at which the axisymmetric mesh is fine enough."""
NARROW_SEAT = 0.5
"""Share of the ring's width that the seat has where it is asked how its width matters."""
SEAT_TOLERANCE = 0.02
"""Change of that peak over two refinements: it says how much the width matters, by 5 to 30 %."""
AGREEMENT = 2 * PEAK_STRESS_TOLERANCE
"""Relative difference of the two bodies' peaks up to which they are one: what both meshes leave open."""
WITHOUT_HOLES = (
    "it is that of the part without its bolt holes, since the part with the ring of the holes cut out has "
    "the same peak and the stress at the holes is below it"
)
KIRSCH = 4.0
"""Largest stress at a small round hole over the plate's, under pure shear; 3 under tension (G. Kirsch, VDI-Z
42 (1898) 797-807). In a row it rises at most as the ligament falls: pitch over ligament (Peterson's Stress
Concentration Factors, row of holes, on the gross section)."""
COARSE = 1.5
"""Of a solid model on the mesh that gave K, where that bound is above the peak. Its nodes at the holes missed
up to 16 % of what meshes of up to six times the elements had (five cups of 2 to 16 holes)."""


def ellipse_peak(flexspline: PartModel) -> StressPeak:
    """By the model that the part's stiffness uses.

    Where the solid model is needed for the stress at the holes alone, and fails, the peak is that without
    holes, and its `shortfall` says so.

    Raises
    ------
    DesignError
    ComputationError, MemoryError : the solve failed.
    """
    if flexspline.axisymmetric:
        return _of_body(flexspline, flexspline.part, "wave generator")[0]
    agreed = _of_two_bodies(flexspline)
    if agreed is not None and agreed.stands_for:
        return agreed
    try:
        return solid_ellipse(flexspline).peak
    except (ComputationError, MemoryError) as fault:
        if agreed is None:
            raise
        why = missing_because(fault)
        words = f"the stress at the bolt holes is not known: {why.words}"
        return replace(agreed, shortfall=replace(why, words=words))


def ellipse_field(flexspline: PartModel) -> SolidField:
    """The field for pictures and files; its peak from the model that answers. Errors as `ellipse_peak`."""
    if flexspline.axisymmetric:
        return replace(coarse_ellipse(flexspline), peak=ellipse_peak(flexspline))
    agreed = _of_two_bodies(flexspline)
    if agreed is not None and agreed.stands_for:
        return replace(coarse_ellipse(flexspline), peak=agreed)
    return solid_ellipse(flexspline)


def half_seat_peak(flexspline: PartModel) -> StressPeak:
    """The ellipse's peak on a seat half as wide, holes left out.

    How wide the bearing that carries the seat is, no design states: the seat is taken as wide as the ring.
    """
    w0, apart = flexspline.context.design.w0_mm, flexspline.part.exclusion_mm

    def make(outline: Meridian, deadline: Deadline) -> StressPeak:
        narrow = with_narrow_seat(outline, NARROW_SEAT)
        own = flexspline.material
        return ellipse_stress(narrow, own, w0, apart, SEAT_TOLERANCE, deadline).peak

    return by_harmonics(
        flexspline, "half_seat_peak", "wave generator, seat half as wide,", make, w0_mm=w0
    )


def _of_two_bodies(flexspline: PartModel) -> StressPeak | None:
    """The whole body's peak, None where the cut one has another.

    It has `stands_for` where it is the part's: where the stress at the holes is certainly below it.
    """
    bolts = flexspline.part.bolts
    if bolts is None or not may_answer(flexspline):
        return None
    bodies = nested_bodies(flexspline.part)
    try:
        whole, at_holes = _of_body(flexspline, bodies.whole, "wave generator", bolts)
        cut, _ = _of_body(flexspline, bodies.cut, "wave generator, ring of the holes cut out,")
    except ComputationError:
        return None
    same = abs(cut.mises_MPa / whole.mises_MPa - 1) <= AGREEMENT
    here = dist(cut.at_mm, whole.at_mm) <= flexspline.part.exclusion_mm
    if not (same and here):
        return None
    if raised(at_holes, bolts) >= whole.mises_MPa:
        try:
            at_holes = _at_holes_of(coarse_ellipse(flexspline), flexspline.part, bolts)
        except (ComputationError, MemoryError):
            return whole
        if COARSE * at_holes >= whole.mises_MPa:
            return whole
    return replace(whole, stands_for=WITHOUT_HOLES)


def _at_holes_of(field: SolidField, part: Part, bolts: BoltCircle) -> float:
    """The largest von Mises stress [MPa] of a solid model's nodes in the annulus of the holes."""
    x, y, z = field.mesh.nodes.T
    return float(field.mises[_in_holes_ring(np.hypot(x, y), z, part, bolts)].max())


def _in_holes_ring(r: np.ndarray, z: np.ndarray, part: Part, bolts: BoltCircle) -> np.ndarray:
    return (bolts.inner <= r) & (r <= bolts.outer) & (z <= part.hole_depth)


def raised(stress_MPa: float, bolts: BoltCircle) -> float:
    """What round holes in a row make of a stress that the plate without them has."""
    if bolts.count == 1:
        return KIRSCH * stress_MPa
    return KIRSCH * stress_MPa * bolts.pitch / (bolts.pitch - 2 * bolts.hole_radius)


def _of_body(
    flexspline: PartModel, body: Part, title: str, bolts: BoltCircle | None = None
) -> tuple[StressPeak, float]:
    """Peak of a body of revolution, and the largest stress [MPa] where `bolts` would be, 0 without them."""
    w0, apart = flexspline.context.design.w0_mm, flexspline.part.exclusion_mm

    def make(outline: Meridian, deadline: Deadline) -> tuple[StressPeak, float]:
        own = flexspline.material
        field = ellipse_stress(outline, own, w0, apart, PEAK_STRESS_TOLERANCE, deadline)
        return field.peak, _in_annulus(field, flexspline.part, bolts) if bolts else 0.0

    holes = {"circle_mm": bolts.radius, "hole_mm": bolts.hole_radius} if bolts else {}
    of_body = replace(flexspline, part=body)
    return by_harmonics(of_body, "wave_generator_peak", title, make, w0_mm=w0, **holes)


def _in_annulus(field: RevolvedField, part: Part, bolts: BoltCircle) -> float:
    """The largest von Mises stress [MPa] at nodes in the annulus of the holes; inf where none lies in it."""
    r, z = field.places.T
    inside = _in_holes_ring(r, z, part, bolts)
    if not inside.any():
        return inf
    angles = (0.0, pi / (2 * field.n))
    return max(float(field.mises(phi)[inside].max()) for phi in angles)
