"""A torque sweep, from its rows to a verdict: the steps in order.

| step | file |
|---|---|
| read the file (`../diagnose.py`) | `measurement/record.py`, `measurement/table.py` |
| refuse an absurd size (`../diagnose.py`) | `../plausibility.py`, `size.py` |
| the steps from here to a torque or an angle that comes late | `judged.py` |
| refuse too few torques | `too_few_torques.py` |
| shorten a long record | `measurement/thinning.py` |
| choose rows, estimate the noise | `row_selection.py`, `measurement/noise.py`, `prepare.py` |
| evaluate the shapes of all causes and the nuisance terms | `regressors.py`, `nuisance_terms.py` |
| evidence of any set of them | `evidence.py` |
| race: search sets, tune shapes, estimate the noise again | `race.py`, `search.py`, `shape_tuning.py` |
| identify causes | `identification.py`, `plausible_sets.py` |
| and their rivals | `rivals.py`, rules in `../decision.py` |
| once more, where a lag beside friction follows no rate | `rate_blind.py` |
| the same with friction ahead of the teeth | `first_ahead.py`, `ahead_tuning.py`, `ahead_race.py` |
| or a shifted reading (both: `step_place.py`) | `first_offset.py`, `torque_offset.py`, `offset_race.py` |
| magnitudes, their deviation, probabilities | `named_causes.py`, `magnitudes.py` |
| what one unit alone shows | `unit_amplitudes.py` |
| test the residual in every channel | `residual_tests.py`, `unexplained.py` |
| test it for what comes back in every cycle | `repeated_misfit.py` |
| test it for what sticks | `jumps.py`, `stuck.py`, `travel_scatter.py` |
| what the causes explain by themselves, and the rest after them | `credit.py` |
| verdict; physical limits | `left_over.py`, `../decision.py`; `limits.py` |
| a torque that comes late | `backward.py` (`loads.py`, `torque_delay.py`) |
| an angle that comes late | `late_angle.py` (`crossing_forms.py`, `crossing_fit.py`) |
| all of them again for each unit, where units differ | `units_apart.py` |
| error on data held out; the model | `splits.py`, `held_out.py`; `written_model.py` |
| next measurement | `next_measurement.py`, `../plans.py` |
"""

from __future__ import annotations

from dataclasses import dataclass

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
from flexspline.pipeline.diagnosis.sweep.held_out import gains_of, refuted
from flexspline.pipeline.diagnosis.sweep.judged import JudgedSweep, judge
from flexspline.pipeline.diagnosis.sweep.next_measurement import after_late, next_measurement
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.residual_tests import ChannelTest
from flexspline.pipeline.diagnosis.sweep.units_apart import UnitsApart, units_apart
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


def diagnose_sweep(
    sweep: Sweep, prediction: Prediction
) -> tuple[DiagnosisOutcome, SweepAnalysis | None]:
    """The verdict on a sweep and what stands behind it; None where there are too few data."""
    whole = judge(sweep, prediction)
    if not isinstance(whole, JudgedSweep):
        return _insufficient(whole), None
    apart = units_apart(whole)
    shown = apart.shown if apart else whole
    explained, own = shown.explained, shown.decision
    ids = [c.id for c in own.causes]
    gain, levels = gains_of(explained, ids)
    fails = refuted(levels)
    decision = _tested(apart.decision if apart else own, fails)
    late = shown.misread
    outcome = DiagnosisOutcome(
        decision.verdict,
        decision.causes,
        decision.unexplained,
        gain,
        after_late(late) if late else next_measurement(explained, _tested(own, fails)),
        gains_at_levels=levels,
    )
    written = written_model(explained, shown.sweep, ids, gain)
    return outcome, SweepAnalysis(
        explained, written.model, written.doubt, shown.left.tests, own.causes, apart
    )


def _tested(decision: Decision, fails: Unexplained | None) -> Decision:
    """A decision where held-out data refute its causes, or do not."""
    if fails is None:
        return decision
    return overruled(fails, decision.causes, decision.unexplained)


def _insufficient(shortage: Shortage) -> DiagnosisOutcome:
    whole = NextMeasurement("torque_Nm", "more_data", doing=Doing("whole_sweeps"))
    return DiagnosisOutcome(
        "insufficient",
        next_measurement=whole,
        too_little=shortage,
    )
