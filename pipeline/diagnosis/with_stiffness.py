"""A measured file and a design in, a diagnosis out: K_b and K_e as given, or solved first."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from flexspline.geometry.design import Design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis, diagnose_measurement
from flexspline.pipeline.diagnosis.measurement.record import read_measurement
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.stiffness_pair import StiffnessPair, given_pair, stiffness_pair

if TYPE_CHECKING:
    from flexspline.pipeline.parts import AnalysisContext


@dataclass(frozen=True)
class GivenStiffness:
    """K_b and K_e [N·m/rad] as a person states them; None: by FE.

    `names` : what a message puts before each, such as "--Kb ".
    """

    pair: tuple[float | None, float | None]
    names: tuple[str, str]

    @property
    def stated(self) -> tuple[str, ...]:
        """Those that are given, in words such as "--Kb 31.3"."""
        both = zip(self.names, self.pair, strict=True)
        return tuple(f"{name}{K:g}" for name, K in both if K is not None)


@dataclass(frozen=True)
class DiagnosisOptions:
    """How a file is read, and what it is compared with.

    Attributes
    ----------
    counts_per_turn : of the encoder, where a column is in counts.
    gear : compare with the curve of the whole gear, not with the straight line of the backlash sum.
    """

    counts_per_turn: float | None = None
    gear: bool = False


PLAIN = DiagnosisOptions()
"""As most files need: their angle is in a unit, and a sum's straight line is what they are held against."""


def diagnose_with_stiffness(
    design: Design,
    csv: Path,
    given: GivenStiffness,
    context: Callable[[], AnalysisContext],
    options: DiagnosisOptions = PLAIN,
    progress: Progress | None = None,
) -> tuple[Diagnosis, StiffnessPair]:
    """The diagnosis, and the stiffnesses that it used.

    Parameters
    ----------
    context : asked for where something is solved, as that loads the solvers.
    progress : is told the stages.

    Raises
    ------
    DesignError : stiffnesses given beside the gear's curve.
    StiffnessValueError : a stiffness given is no positive, finite number.
    MeasurementError : the file cannot be accepted.
    ComputationError : a stiffness that is needed was not found, or the gear has no equilibrium.
    """
    if options.gear:
        from flexspline.pipeline.diagnosis.whole_gear.against import refuse_given

        refuse_given(*given.pair)
    pair = given_pair(*given.pair)
    measurement = read_measurement(
        csv, options.counts_per_turn
    )  # refused before the long work, if bad
    stated = given.stated
    used = pair or stiffness_pair(context(), *given.pair)
    chain = None
    if options.gear:
        from flexspline.pipeline.gear.gear_chain import chain_of

        chain = chain_of(context())
    with (progress or Progress()).stage("diagnosis"):
        diagnosis = diagnose_measurement(
            design, measurement, used, None if stated else context(), chain, stated
        )
    return diagnosis, used
