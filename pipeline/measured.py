"""The Python function for measured files: `diagnose`, like the command."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from flexspline.geometry.errors import DesignError
from flexspline.geometry.input_file import file_name
from flexspline.pipeline.given import require_design

if TYPE_CHECKING:
    from flexspline.geometry.design import Design
    from flexspline.pipeline.diagnosis.diagnose import Diagnosis
    from flexspline.pipeline.parts import AnalysisContext


def diagnose(
    design: Design,
    path: Path | str,
    K_b: float | None = None,
    K_e: float | None = None,
    *,
    counts_per_turn: float | None = None,
    against: Literal["sum", "gear"] = "sum",
) -> Diagnosis:
    """Find what the simulation leaves out, from a measured file; K [N·m/rad] by FE where not given.

    Parameters
    ----------
    counts_per_turn : of the encoder, where the file's angle is in counts.
    against : the straight line of the backlash sum, or the curve of the whole gear (`gear`), without K.

    Returns
    -------
    Diagnosis : `verdict`, `causes`, and `model`, which predicts other histories.

    Raises
    ------
    DesignError
    StiffnessValueError : a stiffness given is no positive, finite number.
    MeasurementError : the file cannot be accepted.
    ComputationError : a stiffness that is needed was not found.
    NestingError : two models contradict each other; no figure is to be trusted.

    Examples
    --------
    The example's record was made with friction and a gap that shrinks as the gear warms up
    (examples/measured/make_sweep.py):

    >>> from flexspline import diagnose, load_design
    >>> design = load_design("examples/xb1-40.toml")
    >>> diagnosis = diagnose(design, "examples/measured/xb1-40-sweep.csv", K_b=31377, K_e=43275)
    >>> diagnosis.verdict, sorted(cause.id for cause in diagnosis.causes)
    ('named', ['friction_hysteresis', 'thermal_clearance'])
    >>> cold, warm = (diagnosis.model.angle_arcsec([1.0, -1.0], temperature_C=[T, T]) for T in (20, 40))
    >>> bool(warm[0] - warm[1] < cold[0] - cold[1])
    True
    """
    from flexspline.pipeline.diagnosis.with_stiffness import (
        DiagnosisOptions,
        GivenStiffness,
        diagnose_with_stiffness,
    )

    @cache
    def context() -> AnalysisContext:
        from flexspline.pipeline.analysis import analysis_context

        return analysis_context(design)

    require_design(design)
    if against not in ("sum", "gear"):
        raise DesignError("against", against, 'must be "sum" or "gear"')
    diagnosis, _ = diagnose_with_stiffness(
        design,
        file_name(path, "measured data"),
        GivenStiffness((K_b, K_e), ("K_b = ", "K_e = ")),
        context,
        DiagnosisOptions(counts_per_turn, gear=against == "gear"),
    )
    return diagnosis
