"""Load cases of lobes and wave generator on the flexspline's rim: axisymmetric, solid, or fast model.

Commands, studies and the live page solve the load cases of `rim_case` by `CASES`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from flexspline.fea.axisymmetric.contact import contact_stiffness
from flexspline.fea.types import Stiffness
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.nested import nested_bodies
from flexspline.geometry.part import Part
from flexspline.pipeline.by_harmonics import by_harmonics, rim_by_harmonics
from flexspline.pipeline.enclosed_part import (
    FAR_BOUNDS_PCT,
    bodies_if_any,
    body_model,
    bounds_pct,
    enclosure_of,
    has_enclosure,
    may_answer,
    without_holes,
)
from flexspline.pipeline.enclosure import TwoBodies, answered_within, check_against
from flexspline.pipeline.lift_off_with_holes import resting_with_holes
from flexspline.pipeline.lobes_by_torsion import entry_doubt, lobes_by_torsion
from flexspline.pipeline.lobes_with_holes import lobes_with_holes
from flexspline.pipeline.part_stiffness import part_stiffness, revolved_stiffness
from flexspline.pipeline.parts import PartModel
from flexspline.pipeline.revolved import contact, rim
from flexspline.pipeline.rim_case import RIM_CASES, RimCase, RimSolve, figure_of
from flexspline.pipeline.solid_lobes import solid_lobes


@dataclass(frozen=True)
class RimModels:
    """How one load case of the rim is solved.

    `revolved` solves a body of revolution, `bodies` the two around a part with bolt holes.
    `solid` is the solid model alone, `with_holes` is for parts with bolt holes where no model is asked for
    by name: where `solid` is None it answers under any setting, else where two bodies of revolution do not.
    `fast` is for studies and the live page: of a part, to bounds of a relative width; it writes no cache.
    """

    revolved: Callable[[PartModel], Stiffness]
    bodies: Callable[[PartModel], TwoBodies]
    fast: Callable[[Part, float], Stiffness]
    solid: Callable[[PartModel], Stiffness] | None = None
    with_holes: Callable[[PartModel], Stiffness] | None = None


def rim_stiffness(flexspline: PartModel, case: RimCase) -> Stiffness:
    """Return K_b of one lobe case, by the model that the part's stiffness uses.

    A part with bolt holes is answered by two bodies of revolution where they lie within the tolerance; where
    the solid model is asked for by name, its K is only checked against them. A case without a solid model is
    theirs under any setting; lift-off is helped by K held of the part where they are far apart.

    Raises
    ------
    DesignError
    NestingError : the solid model's K lies outside.
    ComputationError : the solve failed; or lift-off without holes is asked of the solid model.
    """
    models = CASES[case]
    if flexspline.axisymmetric:
        return models.revolved(flexspline)
    if models.with_holes is not None and has_enclosure(flexspline):
        if models.solid is None:
            return models.with_holes(flexspline)
        if may_answer(flexspline):
            bodies = bodies_if_any(flexspline, models.bodies)
            if bodies is None:
                return models.with_holes(flexspline)
            return _enclosed_rim(flexspline, bodies, models.with_holes)
    if models.solid is None:
        raise ComputationError(
            f"{RIM_CASES[case].title} ({case}) is solved on the meridian only: not with solver.model ="
            f' "{flexspline.context.design.solver.model}"; "auto" works'
        )
    solid = models.solid(flexspline)
    if bodies := bodies_if_any(flexspline, models.bodies):
        check_against(solid, enclosure_of(flexspline, bodies))
    return solid


def _enclosed_rim(
    flexspline: PartModel, bodies: TwoBodies, with_holes: Callable[[PartModel], Stiffness]
) -> Stiffness:
    """K_b between two bodies of revolution. If they are too far apart: K_b from torsion, within them; if that
    is not enough, the solved change by the holes."""
    answer, tolerance = enclosure_of(flexspline, bodies), flexspline.tolerance
    if answer.half_width > tolerance:
        try:
            K_b = part_stiffness(flexspline)
        except (ComputationError, MemoryError) as fault:
            flexspline.context.progress.note(f"  no K_b in torsion to begin with: {fault}")
        else:
            answer = answered_within(
                answer, lambda: _by_torsion(flexspline, K_b, bodies), tolerance
            )
    if answer.half_width <= tolerance:
        return answer
    return answered_within(answer, lambda: with_holes(flexspline), tolerance)


def _by_torsion(flexspline: PartModel, K_b: Stiffness, bodies: TwoBodies) -> Stiffness:
    """K_b under the lobes from that in torsion and the two bodies of revolution."""
    whole = without_holes(flexspline, revolved_stiffness)
    f = flexspline.context.design.flexspline
    return lobes_by_torsion(K_b, whole, bodies, f.bolt_count, flexspline.tolerance, entry_doubt(f))


def by_itself(
    case: RimCase,
    solve: RimSolve,
    solid: Callable[[PartModel], Stiffness] | None = None,
    with_holes: Callable[[PartModel], Stiffness] | None = None,
) -> RimModels:
    """Return the models of a case that `solve` answers on a meridian without another case's answer."""

    of_part = partial(rim_by_harmonics, case=case, solve=solve)

    def bodies(flexspline: PartModel) -> TwoBodies:
        whole = without_holes(flexspline, of_part)
        too_far = whole.lower_Nm_per_rad - 2 * flexspline.tolerance * whole.K_Nm_per_rad
        cut = body_model(flexspline, nested_bodies(flexspline.part).cut, bounds_pct(flexspline))
        return TwoBodies(
            of_part(cut, far_below_Nm_per_rad=too_far, far_bounds_pct=FAR_BOUNDS_PCT), whole
        )

    def enclosure(flexspline: PartModel) -> Stiffness:
        return enclosure_of(flexspline, bodies(flexspline))

    def fast(part: Part, width: float) -> Stiffness:
        return rim(part, solve, width)

    return RimModels(of_part, bodies, fast, solid, with_holes or enclosure)


def _resting(flexspline: PartModel) -> Stiffness:
    held = CASES["lobes"].revolved(flexspline)
    return _resting_on(flexspline, held, flexspline.tolerance)


def _resting_on(flexspline: PartModel, held: Stiffness, tolerance: float) -> Stiffness:
    """Of a body of revolution; `held`: its K with the seat held; `tolerance`: as of `contact_stiffness`."""
    material = flexspline.material
    return by_harmonics(
        flexspline,
        figure_of("lobes_contact"),
        RIM_CASES["lobes_contact"].title,
        lambda outline, deadline: contact_stiffness(outline, material, held, deadline, tolerance),
        held_from_Nm_per_rad=held.lower_Nm_per_rad,
        held_to_Nm_per_rad=held.upper_Nm_per_rad,
        tolerance=tolerance,
    )


def _resting_bodies(flexspline: PartModel, held: TwoBodies) -> TwoBodies:
    """Their ratios to K held are as fine as that of the part asks."""
    bodies = nested_bodies(flexspline.part)
    doubt = _wanted_doubt(held.enclosure().half_width, flexspline)

    def solve(body: Part, body_held: Stiffness) -> Stiffness:
        of_body = body_model(flexspline, body, bounds_pct(flexspline))
        return _resting_on(of_body, body_held, body_held.half_width + doubt)

    return TwoBodies(solve(bodies.cut, held.cut), solve(bodies.whole, held.whole))


def _wanted_doubt(held: float, flexspline: PartModel) -> float:
    """How well each body's ratio must be known, relative. `held`: half-width of the enclosure of K held.

    The ratio's doubt adds to that half-width, so it may take half of what is left of the tolerance. If
    nothing is left, the part's ratio lies between the bodies' ratios, which must be known as well as their K.
    """
    return max(bounds_pct(flexspline) / 100 / 2, (flexspline.tolerance - held) / 2)


def _resting_with_holes(flexspline: PartModel) -> Stiffness:
    held = CASES["lobes"].bodies(flexspline)
    return resting_with_holes(
        flexspline,
        _resting_bodies(flexspline, held),
        held,
        lambda: rim_stiffness(flexspline, "lobes"),
    )


_SOLID: Mapping[RimCase, tuple[Callable[[PartModel], Stiffness], ...]] = {
    "lobes": tuple(partial(f, supported=True) for f in (solid_lobes, lobes_with_holes)),
    "lobes_unsupported": tuple(
        partial(f, supported=False) for f in (solid_lobes, lobes_with_holes)
    ),
}
"""Lift-off breaks the symmetry that makes the solid model small."""
CASES: Mapping[RimCase, RimModels] = {
    **{
        name: by_itself(name, case.solve, *_SOLID.get(name, ()))
        for name, case in RIM_CASES.items()
        if case.solve is not None
    },
    "lobes_contact": RimModels(
        _resting,
        lambda flexspline: _resting_bodies(flexspline, CASES["lobes"].bodies(flexspline)),
        contact,
        with_holes=_resting_with_holes,
    ),
}
SOLID_CASES = tuple(case for case in RIM_CASES if CASES[case].solid is not None)
