"""A measured file and a design in, a diagnosis out: K_b and K_e as given, or solved first."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from flexspline.geometry.design import Design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis, diagnose_measurement
from flexspline.pipeline.diagnosis.measurement.record import read_measurement
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.stiffness_pair import StiffnessPair, given_pair, stiffness_pair

if TYPE_CHECKING:
    from flexspline.pipeline.parts import AnalysisContext


def diagnose_with_stiffness(
    design: Design,
    csv: Path,
    given: tuple[float | None, float | None],
    names: tuple[str, str],
    context: Callable[[], AnalysisContext],
    counts_per_turn: float | None = None,
    gear: bool = False,
    progress: Progress | None = None,
) -> tuple[Diagnosis, StiffnessPair]:
    """The diagnosis, and the stiffnesses that it used.

    Parameters
    ----------
    given : K_b and K_e [N·m/rad]; None: by FE. names : what a message puts before each, such as "--Kb ".
    context : asked for where something is solved, as that loads the solvers.
    counts_per_turn : of the encoder, where a column is in counts.
    gear : compare with the curve of the whole gear, not with the straight line of the backlash sum.
    progress : is told the stages.

    Raises
    ------
    DesignError : stiffnesses given beside the gear's curve.
    StiffnessValueError : a stiffness given is no positive, finite number.
    MeasurementError : the file cannot be accepted.
    ComputationError : a stiffness that is needed was not found, or the gear has no equilibrium.
    """
    if gear:
        from flexspline.pipeline.diagnosis.whole_gear.against import refuse_given

        refuse_given(*given)
    pair = given_pair(*given)
    measurement = read_measurement(csv, counts_per_turn)  # refused before the long work, if bad
    stated = tuple(f"{name}{K:g}" for name, K in zip(names, given, strict=True) if K is not None)
    used = pair or stiffness_pair(context(), *given)
    chain = None
    if gear:
        from flexspline.pipeline.gear_chain import chain_of

        chain = chain_of(context())
    with (progress or Progress()).stage("diagnosis"):
        found = diagnose_measurement(
            design, measurement, used.K_b_Nm_per_rad, used.K_e_Nm_per_rad, used.error,
            None if stated else context(), chain, stated,
        )  # fmt: skip
    return found, used
