"""Figures from Fourier harmonics on a flexspline's meridian: from the cache, or solved in a time limit."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from flexspline.fea.deadline import STAGE_SECONDS, Deadline
from flexspline.fea.types import Stiffness, StressPeak
from flexspline.geometry.outline import Meridian
from flexspline.pipeline.parts import PartModel, is_lasting
from flexspline.pipeline.refining import Refining
from flexspline.pipeline.rim_case import RIM_CASES, RimCase, RimSolve, figure_of

T = TypeVar("T", Stiffness, StressPeak, tuple[StressPeak, float])


def by_harmonics(
    flexspline: PartModel,
    figure: str,
    title: str,
    make: Callable[[Meridian, Deadline], T],
    **more: float,
) -> T:
    """Return a figure of the meridian; `more` is what it depends on beside the part."""
    context = flexspline.context

    def timed() -> T:
        with context.progress.stage(f"{title} by Fourier harmonics"):
            return make(flexspline.part.meridian, Deadline(STAGE_SECONDS))

    inputs: dict[str, Any] = {**flexspline.revolved_key, "figure": figure, **more}
    return context.cache.get("harmonics", inputs, timed, _is_lasting)[0]


def rim_by_harmonics(
    flexspline: PartModel,
    case: RimCase,
    solve: RimSolve,
    far_below_Nm_per_rad: float = 0.0,
    far_bounds_pct: float = 0.0,
) -> Stiffness:
    """Return K_b of a body of revolution in a load case that `solve` answers; errors are those of `solve`.

    Where K is certainly below `far_below_Nm_per_rad`, bounds `far_bounds_pct` apart [% of K] are enough.
    """
    material, width = flexspline.material, flexspline.tolerance

    def enough(K: Stiffness) -> bool:
        far = K.upper_Nm_per_rad < far_below_Nm_per_rad
        return far and 100 * K.half_width <= far_bounds_pct / 2

    return by_harmonics(
        flexspline,
        figure_of(case),
        RIM_CASES[case].title,
        lambda outline, deadline: Refining(solve(outline, material, width, deadline)).until(enough),
        far_below_Nm_per_rad=far_below_Nm_per_rad,
        far_bounds_pct=far_bounds_pct,
    )


def _is_lasting(figure: Stiffness | StressPeak | tuple[StressPeak, float]) -> bool:
    return is_lasting(figure[0] if isinstance(figure, tuple) else figure)
