"""The best design of a study on the wave generator, computed like in `run`, for its picture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from flexspline.fea.types import SolidField
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.ellipse_peak import ellipse_field
from flexspline.pipeline.study.design_faults import DESIGN_FAULTS
from flexspline.pipeline.study.result import StudyResult


@dataclass(frozen=True)
class BestField:
    """The ellipse's field of one design, and the w0 [mm] that it is for."""

    slot: int
    field: SolidField
    w0_mm: float


def best_field(result: StudyResult, say: Callable[[str], None]) -> BestField | None:
    """Return the field of the first design on the front; None where there is none or it fails (`say`)."""
    if result.scatter or not result.pareto:
        return None
    row = result.pareto[0]
    design = result.design_of(row)
    solver = design.solver.model_copy(update={"model": "auto"})
    context = analysis_context(design.model_copy(update={"solver": solver}))
    try:
        field = ellipse_field(context.part("flexspline"))
    except DESIGN_FAULTS as fault:
        say(f"no picture of design {row.slot} on the wave generator: {fault}")
        return None
    return BestField(row.slot, field, design.w0_mm)
