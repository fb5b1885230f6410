"""The two solved bodies that enclose a flexspline with bolt holes, and when they are accurate enough."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from flexspline.fea.types import MET, Shortfall, Stiffness
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.part import Part
from flexspline.pipeline.enclosure import TwoBodies, two_bodies
from flexspline.pipeline.parts import PartModel

BODY_SHARE = 0.3
"""Of the tolerance: what the bounds of each body may take of it. The rest is left to what the holes take off
K, ± 0.06 % on xb1-40, and both bodies still take 0.2 to 0.6 s a load case."""
FAR_BOUNDS_PCT = 0.1
"""Distance of a body's own bounds [% of K] that is enough where BODY_SHARE asks for less and the bodies are
too far apart all the same: most of the enclosure is what the holes take off. Lobes, lift-off, free rim of a
hat with nine holes, ± 0.14 % apart where 0.1 % is asked: 8.6 s of the processor without it, 4.6 with it."""
TOO_FAR = "the part without holes and the part with the ring of its holes cut out differ by more"

PartSolver = Callable[[PartModel], Stiffness]


def has_enclosure(model: PartModel) -> bool:
    """Whether the part lies between two bodies of revolution: a flexspline with bolt holes."""
    return model.name == "flexspline" and model.part.bolts is not None


def may_answer(model: PartModel) -> bool:
    """Whether an enclosure may stand for the solid model: `solver.model` asks for no model by name."""
    return has_enclosure(model) and model.context.design.solver.model == "auto"


def enclosure_of(model: PartModel, bodies: TwoBodies) -> Stiffness:
    """Return K_b of a part that `has_enclosure`; `shortfall` says why its bounds are too wide.

    Raises
    ------
    NestingError
    """
    enclosure = bodies.enclosure()
    if enclosure.half_width <= model.tolerance:
        return replace(enclosure, shortfall=MET)
    return replace(enclosure, shortfall=enclosure.shortfall or Shortfall(TOO_FAR))


def bodies_of(model: PartModel, solve: PartSolver) -> TwoBodies:
    """Solve both bodies of revolution as finely as the enclosure asks; errors are those of `solve`."""
    return two_bodies(model.part, lambda body: solve(body_model(model, body, bounds_pct(model))))


def without_holes(model: PartModel, solve: PartSolver) -> Stiffness:
    """Return K of the part without its holes, as fine as in the enclosure; errors are those of `solve`."""
    return solve(body_model(model, model.part.without_holes(), bounds_pct(model)))


def bounds_pct(model: PartModel) -> float:
    """Return the distance of each body's own bounds that an enclosure asks for [% of K]."""
    return BODY_SHARE * model.context.design.solver.tolerance_pct


def body_model(model: PartModel, body: Part, tolerance_pct: float) -> PartModel:
    """Return a body of revolution in place of the part, with a tolerance of its own."""
    design = model.context.design
    settings = {"tolerance_pct": tolerance_pct, "model": "auto"}
    solver = design.solver.model_copy(update=settings)
    context = replace(model.context, design=design.model_copy(update={"solver": solver}))
    return replace(model, context=context, part=body)


def bodies_if_any(model: PartModel, bodies: Callable[[PartModel], TwoBodies]) -> TwoBodies | None:
    """Return both bodies; None, for the solid model to answer, where there are none or a solve failed."""
    if not has_enclosure(model):
        return None
    try:
        return bodies(model)
    except (ComputationError, MemoryError) as fault:
        model.context.progress.note(f"  no bounds from two bodies of revolution: {fault}")
        return None
