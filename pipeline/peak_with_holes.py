"""The peak stress of a flexspline with bolt holes, where two bodies of revolution have the same one.

The part lies between them (`geometry.nested`). No theorem orders their stresses, but what a load does far
from the holes is the same in both: where both bodies have the same peak at the same place, and the stress
about the holes is below it, the holes do not matter to it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import dist, inf, pi

import numpy as np

from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.deadline import Deadline
from flexspline.fea.types import SolidField, StressPeak
from flexspline.geometry.bolts import BoltCircle
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.nested import nested_bodies
from flexspline.geometry.outline import Meridian
from flexspline.geometry.part import Part
from flexspline.pipeline.by_harmonics import by_harmonics
from flexspline.pipeline.enclosed_part import may_answer
from flexspline.pipeline.parts import PartModel

PEAK_STRESS_TOLERANCE = 0.005
"""Change of a peak stress over two refinements at which the axisymmetric mesh is fine enough, unless K is
asked for more closely."""
CLOSEST_PEAK = 0.001
"""The least such change that is asked for. 24 random flexsplines on the ellipse: 0.18 s at 0.5 %, 0.30 at
0.2 %, 0.56 at 0.1 %."""
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


def peak_tolerance(tolerance: float) -> float:
    """Return the change of a peak over two refinements at which none follows; `tolerance` is that of K."""
    return min(PEAK_STRESS_TOLERANCE, max(CLOSEST_PEAK, tolerance))


@dataclass(frozen=True)
class BodyLoad:
    """A load of a body of revolution.

    Attributes
    ----------
    figure, title : the name of its peak in the cache, and what it is called while it is solved.
    solve : the field on a meridian until a time, to `peak_tolerance`.
    depends_on : what the field depends on beside the body.
    """

    figure: str
    title: str
    solve: Callable[[Meridian, Deadline], RevolvedField]
    depends_on: Mapping[str, float]


def body_peak(model: PartModel, load: BodyLoad) -> StressPeak:
    """Return the peak of a part that is a body of revolution.

    Raises
    ------
    ComputationError : the solve failed.
    """
    return _of_body(model, model.part, load)[0]


def peak_by_two_bodies(
    flexspline: PartModel, load: BodyLoad, solid: Callable[[], SolidField]
) -> StressPeak | None:
    """Return the whole body's peak; None where the cut one has another, or there are no two bodies.

    It has `stands_for` where it is the part's: where the stress at the holes is certainly below it. `solid`
    is the field of the part itself, asked where a bound of that stress does not settle it.
    """
    bolts = flexspline.part.bolts
    if bolts is None or not may_answer(flexspline):
        return None
    bodies = nested_bodies(flexspline.part)
    cut_load = replace(load, title=f"{load.title}, ring of the holes cut out,")
    try:
        whole, at_holes = _of_body(flexspline, bodies.whole, load, bolts)
        cut, _ = _of_body(flexspline, bodies.cut, cut_load)
    except ComputationError:
        return None
    same = abs(cut.mises_MPa / whole.mises_MPa - 1) <= AGREEMENT
    same_place = dist(cut.at_mm, whole.at_mm) <= flexspline.part.exclusion_mm
    if not (same and same_place):
        return None
    if raised(at_holes, bolts) >= whole.mises_MPa:
        try:
            at_holes = _at_holes_of(solid(), flexspline.part, bolts)
        except (ComputationError, MemoryError):
            return whole
        if COARSE * at_holes >= whole.mises_MPa:
            return whole
    return replace(whole, stands_for=WITHOUT_HOLES)


def raised(stress_MPa: float, bolts: BoltCircle) -> float:
    """Return the stress at round holes in a row, from that of the plate without them."""
    if bolts.count == 1:
        return KIRSCH * stress_MPa
    return KIRSCH * stress_MPa * bolts.pitch / (bolts.pitch - 2 * bolts.hole_radius)


def _of_body(
    model: PartModel, body: Part, load: BodyLoad, bolts: BoltCircle | None = None
) -> tuple[StressPeak, float]:
    """Peak of a body of revolution, and the largest stress [MPa] where `bolts` would be, 0 without them."""

    def make(outline: Meridian, deadline: Deadline) -> tuple[StressPeak, float]:
        field = load.solve(outline, deadline)
        return field.peak, _in_annulus(field, model.part, bolts) if bolts else 0.0

    holes = {"circle_mm": bolts.radius, "hole_mm": bolts.hole_radius} if bolts else {}
    of_body = replace(model, part=body)
    return by_harmonics(of_body, load.figure, load.title, make, **load.depends_on, **holes)


def _in_annulus(field: RevolvedField, part: Part, bolts: BoltCircle) -> float:
    """The largest von Mises stress [MPa] at nodes in the annulus of the holes; inf where none lies in it."""
    r, z = field.places.T
    inside = _in_holes_ring(r, z, part, bolts)
    if not inside.any():
        return inf
    angles = (0.0, pi / (2 * field.n)) if field.n else (0.0,)
    return max(float(field.mises(phi)[inside].max()) for phi in angles)


def _at_holes_of(field: SolidField, part: Part, bolts: BoltCircle) -> float:
    """The largest von Mises stress [MPa] of a solid model's nodes in the annulus of the holes."""
    x, y, z = field.mesh.nodes.T
    return float(field.mises[_in_holes_ring(np.hypot(x, y), z, part, bolts)].max())


def _in_holes_ring(r: np.ndarray, z: np.ndarray, part: Part, bolts: BoltCircle) -> np.ndarray:
    return (bolts.inner <= r) & (r <= bolts.outer) & (z <= part.hole_depth)
