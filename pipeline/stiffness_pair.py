"""K_b and K_e for the backlash: given by the user, or solved."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from flexspline.fea.types import Stiffness
from flexspline.pipeline.backlash import require_stiffness, series_compliance

if TYPE_CHECKING:
    from flexspline.pipeline.parts import AnalysisContext
    from flexspline.pipeline.stiffnesses import Stiffnesses


@dataclass(frozen=True)
class StiffnessPair:
    """K_b and K_e [N·m/rad].

    `solved`: what FE found, None where both came from the user; `error`: the solver's relative error of
    both in series.
    """

    K_b_Nm_per_rad: float
    K_e_Nm_per_rad: float
    solved: Stiffnesses | None = None
    error: float = 0.0

    @property
    def given(self) -> bool:
        """Whether both came from the user."""
        return self.solved is None


def given_pair(K_b: float | None, K_e: float | None) -> StiffnessPair | None:
    """Return both K [N·m/rad] that the user gave, as doubles; None where one is to be solved.

    Raises
    ------
    StiffnessValueError : a stiffness given is no positive, finite number.
    """
    for name, K in (("K_b", K_b), ("K_e", K_e)):
        if K is not None:
            require_stiffness(name, K)
    return None if K_b is None or K_e is None else StiffnessPair(float(K_b), float(K_e))


def stiffness_pair(
    context: AnalysisContext, K_b: float | None = None, K_e: float | None = None
) -> StiffnessPair:
    """Return both K [N·m/rad], by FE where not given; a K that is given has no error of the solver.

    Raises
    ------
    DesignError
    StiffnessValueError : a stiffness given is no positive, finite number.
    NotFoundError : a stiffness that is needed failed.
    """
    if given := given_pair(K_b, K_e):
        return given
    from flexspline.pipeline.analysis import stiffnesses

    rim = context.design.solver.sum_at_lobes
    result = stiffnesses(context, flexspline=K_b is None, shaft=K_e is None, rim=rim)
    solved: list[Stiffness] = []
    if K_b is None:
        solved.append(result.in_sum(context.design))
        K_b = solved[-1].K_Nm_per_rad
    if K_e is None:
        solved.append(result.K_e)
        K_e = solved[-1].K_Nm_per_rad
    doubt = sum((1 / K.lower_Nm_per_rad - 1 / K.upper_Nm_per_rad) / 2 for K in solved)
    K_b, K_e = float(K_b), float(K_e)
    return StiffnessPair(K_b, K_e, result, doubt / series_compliance(K_b, K_e))
