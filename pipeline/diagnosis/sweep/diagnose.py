"""A torque sweep, from its rows to a verdict and what follows: `diagnose_sweep` has the steps in order.

Beside a step stands its file, which imports whatever else the step needs. The first, `judge`, has steps of
its own, from a record's rows to its verdict: units that differ take them again, each by its own rows. Before
all, `../with_stiffness.py` reads the file and `../diagnose.py` refuses an absurd size. The reasons of the
steps: docs/diagnosis.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from flexspline.pipeline.diagnosis.calibration import Calibration
from flexspline.pipeline.diagnosis.decision import Decision, overruled
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.model.doubt import PredictionUncertainty
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import (
    DiagnosisOutcome,
    Doing,
    NamedCause,
    NextMeasurement,
    Unexplained,
)
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.shortage import Shortage
from flexspline.pipeline.diagnosis.sweep.held_out import gains_of, refuted, unpredicted
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.sweep.next_measurement import after_late, next_measurement
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import ChannelTest
from flexspline.pipeline.diagnosis.sweep.separate_units import UnitsApart, units_apart
from flexspline.pipeline.diagnosis.sweep.verdict import JudgedSweep, judge
from flexspline.pipeline.diagnosis.sweep.written_model import written_model


@dataclass(frozen=True)
class SweepAnalysis:
    """What stands behind the verdict on a sweep, with all that a figure or a report needs.

    `model` is the calibrated simulation with the `causes` found, `doubt` what its predictions may be off by;
    `tests` are of what it leaves. All of it is of one unit, `apart.unit`, where units are judged `apart`.
    """

    explained: ExplainedSweep
    model: ExtendedModel
    doubt: PredictionUncertainty
    tests: tuple[ChannelTest, ...]
    causes: tuple[NamedCause, ...]
    apart: UnitsApart | None = None

    @cached_property
    def calibration(self) -> Calibration:
        """Gap and compliance as the record has them, of what its units have in common."""
        return calibration_of(self.explained)  # magnitudes/calibration_std.py


def diagnose_sweep(
    sweep: Sweep, prediction: Prediction
) -> tuple[DiagnosisOutcome, SweepAnalysis | None]:
    """The verdict on a sweep and what stands behind it; None where there are too few data."""
    whole = judge(sweep, prediction)  # verdict.py
    if not isinstance(whole, JudgedSweep):
        return _insufficient(whole), None
    apart = units_apart(whole)  # separate_units.py
    shown = apart.shown if apart else whole
    explained, own = shown.explained, shown.decision
    ids = [c.id for c in own.causes]
    gain, levels = gains_of(explained, ids)  # held_out.py
    fails = refuted(levels)  # held_out.py
    if fails is None and own.verdict in ("named", "ambiguous"):
        fails = unpredicted(gain)  # held_out.py
    decision = _tested(apart.decision if apart else own, fails)
    then: NextMeasurement | None
    if shown.misread:
        then = after_late(shown.misread)  # next_measurement.py
    else:
        then = next_measurement(explained, _tested(own, fails))  # next_measurement.py
    written = written_model(explained, shown.sweep, ids, gain)  # written_model.py
    outcome = DiagnosisOutcome(
        decision.verdict, decision.causes, decision.unexplained, gain, then, gains_at_levels=levels
    )
    return outcome, SweepAnalysis(
        explained, written.model, written.doubt, shown.left.tests, own.causes, apart
    )


def _tested(decision: Decision, fails: Unexplained | None) -> Decision:
    """A decision where held-out data refute its causes, or do not."""
    if fails is None:
        return decision
    return overruled(fails, decision.causes, decision.unexplained)  # ../decision.py


def _insufficient(shortage: Shortage) -> DiagnosisOutcome:
    whole = NextMeasurement("torque_Nm", "more_data", doing=Doing("whole_sweeps"))
    return DiagnosisOutcome(
        "insufficient",
        next_measurement=whole,
        too_little=shortage,
    )
