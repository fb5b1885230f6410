"""The enclosure of a design's flexspline with bolt holes: its two bodies solved, and where it may answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf

from flexspline.fea.types import MET, Shortfall, Stiffness
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.part import Part
from flexspline.pipeline.enclosure import TwoBodies, two_bodies
from flexspline.pipeline.parts import PartModel

BODY_SHARE = 0.3
"""Of the tolerance: what the bounds of each body may take of it. The rest is left to what the holes take off
K, ± 0.06 % on xb1-40, and both bodies still take 0.2 to 0.6 s a load case."""
FIRST_BOUNDS_PCT, FAR_HALF_WIDTHS = 0.1, 3.0
"""Distance of each body's own bounds at first [% of K], where BODY_SHARE asks for less; and the enclosure's
half-width over the tolerance beyond which it stays so: most of it is what the holes take off. Lobes, lift-off
and free rim of a hat with sixteen holes, 0.1 % asked: ± 0.30, 0.75 and 1.46 % in 7.0 s of the processor,
± 0.32, 0.78 and 1.48 % in 4.9."""
TOO_FAR = "the part without holes and the part with the ring of its holes cut out differ by more"

PartSolver = Callable[[PartModel], Stiffness]


def has_enclosure(model: PartModel) -> bool:
    """Whether the part lies between two bodies of revolution: a flexspline with bolt holes."""
    return model.name == "flexspline" and model.part.bolts is not None


def may_answer(model: PartModel) -> bool:
    """Whether an enclosure may stand for the solid model: `solver.model` asks for no model by name."""
    return has_enclosure(model) and model.context.design.solver.model == "auto"


def enclosure_of(model: PartModel, solve: PartSolver, expected: float = inf) -> Stiffness:
    """K_b of a part that `has_enclosure`; `solve` solves a load case of a body of revolution.

    `expected` is the half-width of another load case, 0 where a fine solution costs little: where it is near
    the tolerance, the bodies are solved at once as finely as that takes. Where half of the distance is more
    than the tolerance, `shortfall` says why; where it is more than FAR_HALF_WIDTHS tolerances, they are
    solved no finer than to FIRST_BOUNDS_PCT.

    Raises
    ------
    NestingError
    ComputationError : of `solve`.
    """
    found = by_two_bodies(model, solve, TwoBodies.enclosure, expected)
    if found.half_width <= model.tolerance:
        return replace(found, shortfall=MET)
    return replace(found, shortfall=found.shortfall or Shortfall(TOO_FAR))


def by_two_bodies(
    model: PartModel,
    solve: PartSolver,
    answer: Callable[[TwoBodies], Stiffness],
    expected: float = inf,
    most_pct: float = inf,
) -> Stiffness:
    """What `answer` makes of both bodies, each solved as finely as that is near the tolerance.

    `most_pct`: distance of each body's own bounds at most, when they are solved finely. Errors as of `solve`
    and `answer`; see `enclosure_of`.
    """
    finest_pct = min(BODY_SHARE * model.context.design.solver.tolerance_pct, most_pct)
    near = FAR_HALF_WIDTHS * model.tolerance
    first_pct = finest_pct if expected <= near else max(FIRST_BOUNDS_PCT, finest_pct)
    found = answer(_bodies_to(model, solve, first_pct))
    if finest_pct < first_pct and found.half_width <= near:
        found = answer(_bodies_to(model, solve, finest_pct))
    return found


def without_holes(model: PartModel, solve: PartSolver) -> Stiffness:
    """K of the part without its holes, as finely as the enclosure has it; errors as of `solve`."""
    share = BODY_SHARE * model.context.design.solver.tolerance_pct
    return _body_to(model, solve, share)(model.part.without_holes())


def _bodies_to(model: PartModel, solve: PartSolver, tolerance_pct: float) -> TwoBodies:
    """`two_bodies`, each solved to its own tolerance."""
    return two_bodies(model.part, _body_to(model, solve, tolerance_pct))


def _body_to(
    model: PartModel, solve: PartSolver, tolerance_pct: float
) -> Callable[[Part], Stiffness]:
    """What solves a body in place of the part, to a tolerance of its own."""
    design = model.context.design
    asked = {"tolerance_pct": tolerance_pct, "model": "auto"}
    solver = design.solver.model_copy(update=asked)
    context = replace(model.context, design=design.model_copy(update={"solver": solver}))
    return lambda body: solve(replace(model, context=context, part=body))


def enclosure_if_any(
    model: PartModel, solve: PartSolver, expected: float = inf
) -> Stiffness | None:
    """`enclosure_of` where there is one and it can be solved: the solid model answers without it too.

    Raises
    ------
    NestingError
    """
    if not has_enclosure(model):
        return None
    try:
        return enclosure_of(model, solve, expected)
    except (ComputationError, MemoryError) as fault:
        model.context.progress.note(f"  no bounds from two bodies of revolution: {fault}")
        return None
