"""A measurement and a design in, a diagnosis out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from flexspline.geometry.design import Design
from flexspline.pipeline.analysis import CACHED_TYPES
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.diagnosis.end_points.diagnose import diagnose_end_points
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis
from flexspline.pipeline.diagnosis.measurement.record import (
    EndPoints,
    Specimens,
    Sweep,
    read_measurement,
)
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import (
    DiagnosisOutcome,
    NamedCause,
    NextMeasurement,
    Verdict,
)
from flexspline.pipeline.diagnosis.prediction import Prediction, prediction_of
from flexspline.pipeline.diagnosis.specimens.diagnose import diagnose_specimens
from flexspline.pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from flexspline.pipeline.diagnosis.sweep.held_out import gain_of
from flexspline.pipeline.diagnosis.sweep.named_causes import model_of, named_causes
from flexspline.pipeline.diagnosis.sweep.offset_race import ExplainedSweep, diagnosed
from flexspline.pipeline.diagnosis.sweep.prepare import TooFewRowsError
from flexspline.pipeline.diagnosis.sweep.residual_tests import ChannelTest, channel_tests
from flexspline.pipeline.diagnosis.sweep.verdict import (
    next_of,
    notes_of,
    summary_of,
    unexplained_of,
    verdict_of,
)
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.storage import cache_folder

STILL = 0.1
"""Torque that varies by less than this share of its largest value is constant."""


@dataclass(frozen=True)
class Diagnosis:
    """What was found, with all that a report needs.

    Attributes
    ----------
    outcome : the verdict, causes, gain. explained : the race, None where it was not run.
    model : the extended model, None where nothing was fitted. left_over : what the best model leaves,
        tested in each channel.
    """

    design: Design
    measurement: Sweep | EndPoints | Specimens
    prediction: Prediction
    outcome: DiagnosisOutcome
    explained: ExplainedSweep | None = None
    model: ExtendedModel | None = None
    end_points: EndPointAnalysis | None = None
    specimens: SpecimenAnalysis | None = None
    left_over: tuple[ChannelTest, ...] = ()

    @property
    def verdict(self) -> Verdict:
        """What the diagnosis says, in one word."""
        return self.outcome.verdict

    @property
    def causes(self) -> tuple[NamedCause, ...]:
        """What the simulation leaves out, the largest first."""
        return self.outcome.causes


def diagnose_file(
    design: Design,
    csv: Path,
    K_b: float,
    K_e: float,
    K_error: float = 0.0,
    context: AnalysisContext | None = None,
) -> Diagnosis:
    """Read a measurement and diagnose it.

    Stiffnesses in N·m/rad; `K_error` is the solver's relative error of them in series. `context`, where
    they came from FE: specimens are then solved like the design; without it, given stiffnesses are
    scaled from specimen to specimen by the hole-free model.

    Raises
    ------
    MeasurementError : the file cannot be accepted.
    BearingPlayDomainError : bearing play beyond c_max (involute model).
    """
    measurement = read_measurement(csv)
    prediction = prediction_of(design, K_b, K_e, K_error)
    if isinstance(measurement, Sweep):
        return diagnose_sweep(design, measurement, prediction)
    if isinstance(measurement, EndPoints):
        outcome, analysis, model = diagnose_end_points(design, measurement, prediction)
        return Diagnosis(design, measurement, prediction, outcome, model=model, end_points=analysis)
    bench = context or _quiet_context(design)
    outcome, found = diagnose_specimens(
        design, measurement, K_b, K_e, bench, full=context is not None
    )
    return Diagnosis(design, measurement, prediction, outcome, specimens=found)


def _quiet_context(design: Design) -> AnalysisContext:
    """For the hole-free model's ratios, where stiffnesses were given."""
    return AnalysisContext(design, Cache(cache_folder(), CACHED_TYPES), Progress())


def diagnose_sweep(design: Design, sweep: Sweep, prediction: Prediction) -> Diagnosis:
    """Diagnose a torque sweep."""
    reason = _too_little(sweep)
    if reason:
        return _insufficient(design, sweep, prediction, reason)
    try:
        explained = diagnosed(sweep, prediction)
    except TooFewRowsError as error:
        return _insufficient(design, sweep, prediction, str(error))
    decision = explained.decision
    found = named_causes(explained)
    model = model_of(decision.fit, sweep, [c.id for c in found], explained.offset_Nm)
    tests = channel_tests(explained.prepared, decision.fit)
    unexplained = unexplained_of(explained, tests)
    verdict = verdict_of(explained, found, tests)
    if verdict == "consistent":
        unexplained = ()
    outcome = DiagnosisOutcome(
        verdict,
        found,
        unexplained,
        gain_of(explained, [c.id for c in found]) if verdict != "insufficient" else None,
        next_of(explained, found, verdict, unexplained),
        summary_of(verdict, found, unexplained),
        notes_of(explained),
    )
    return Diagnosis(design, sweep, prediction, outcome, explained, model, left_over=tuple(tests))


def _too_little(sweep: Sweep) -> str | None:
    torque = sweep.history.torque_Nm
    largest = float(np.abs(torque).max())
    if largest == 0 or np.ptp(torque) < STILL * largest:
        return "the torque is constant, so neither stiffness nor gap can be seen"
    if len(np.unique(np.round(torque / largest, 2))) < 4:
        return "fewer than four different torques"
    return None


def _insufficient(design: Design, sweep: Sweep, prediction: Prediction, reason: str) -> Diagnosis:
    advice = NextMeasurement(
        "torque_Nm",
        "sweep the torque 0 → +T → 0 → −T → 0 twice, with at least 100 rows a cycle",
        0.0,
    )
    summary = f"Too little data to say anything: {reason}."
    return Diagnosis(
        design, sweep, prediction, DiagnosisOutcome("insufficient", (), (), None, advice, summary)
    )
