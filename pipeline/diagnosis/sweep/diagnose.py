"""A torque sweep, from its rows to a verdict: the steps in order.

| step | file |
|---|---|
| read the file (`../diagnose.py`) | `measurement/record.py`, `measurement/table.py` |
| refuse an absurd size (`../diagnose.py`) | `../plausibility.py`, `size.py` |
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
| what one unit alone shows | `unit_amplitudes.py`, `own_units.py` |
| test the residual in every channel | `residual_tests.py`, `unexplained.py` |
| test it for what comes back in every cycle | `repeated_misfit.py` |
| test it for what sticks | `jumps.py`, `stuck.py`, `travel_scatter.py` |
| what the causes explain by themselves, and the rest after them | `credit.py` |
| verdict; physical limits | `left_over.py`, `../decision.py`; `limits.py` |
| a torque that comes late | `backward.py` (`loads.py`, `torque_delay.py`) |
| an angle that comes late | `late_angle.py` (`crossing_forms.py`, `crossing_fit.py`) |
| error on data held out; the model | `splits.py`, `held_out.py`; `written_model.py` |
| next measurement | `next_measurement.py`, `../plans.py` |
"""

from __future__ import annotations

from dataclasses import dataclass

from flexspline.pipeline.diagnosis.decision import Decision, overruled
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.thinning import thinned
from flexspline.pipeline.diagnosis.model.doubt import PredictionUncertainty
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import (
    DiagnosisOutcome,
    Doing,
    NextMeasurement,
    Unexplained,
)
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.shortage import FewRows, Shortage
from flexspline.pipeline.diagnosis.structure import BackwardLoop, LateAngle
from flexspline.pipeline.diagnosis.sweep.ahead_race import with_friction_ahead
from flexspline.pipeline.diagnosis.sweep.backward import backward_of
from flexspline.pipeline.diagnosis.sweep.held_out import gains_of, refuted
from flexspline.pipeline.diagnosis.sweep.late_angle import late_angle_of
from flexspline.pipeline.diagnosis.sweep.left_over import judged, left_over
from flexspline.pipeline.diagnosis.sweep.limits import broken_limit, drowned, slow_noise
from flexspline.pipeline.diagnosis.sweep.named_causes import named_causes
from flexspline.pipeline.diagnosis.sweep.next_measurement import after_late, next_measurement
from flexspline.pipeline.diagnosis.sweep.offset_race import with_torque_offset
from flexspline.pipeline.diagnosis.sweep.prepare import PreparedSweep, TooFewRowsError, prepare
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep, run_race
from flexspline.pipeline.diagnosis.sweep.residual_tests import ChannelTest
from flexspline.pipeline.diagnosis.sweep.too_few_torques import too_few_torques
from flexspline.pipeline.diagnosis.sweep.written_model import written_model


@dataclass(frozen=True)
class SweepAnalysis:
    """What stands behind the verdict on a sweep, with all that a figure or a report needs.

    `model` is the calibrated simulation with the causes found, `doubt` what its predictions may be off by;
    `tests` are of what it leaves.
    """

    explained: ExplainedSweep
    model: ExtendedModel
    doubt: PredictionUncertainty
    tests: tuple[ChannelTest, ...]


def diagnose_sweep(
    sweep: Sweep, prediction: Prediction
) -> tuple[DiagnosisOutcome, SweepAnalysis | None]:
    """The verdict on a sweep and what stands behind it; None where there are too few data."""
    shortage = too_few_torques(sweep)
    if shortage is not None:
        return _insufficient(shortage), None
    try:
        prepared = prepare(thinned(sweep), prediction)
    except TooFewRowsError as error:
        return _insufficient(FewRows(error.count, error.wanted)), None
    explained = with_friction_ahead(prepared) or with_torque_offset(run_race(prepared))
    if (hidden := drowned(explained)) is not None:
        return _insufficient(hidden), None
    causes = named_causes(explained)
    left = left_over(explained)
    decision = judged(explained, causes, left)
    broken = broken_limit(sweep, explained, decision.causes)
    if broken is not None:
        decision = overruled(broken, beside=decision.unexplained)
    if decision.verdict == "consistent" and (slow := slow_noise(explained)) is not None:
        decision = overruled(slow)
    misread = _misread(prepared, explained, decision)
    if misread is not None:  # whatever else was found is what the race made of it
        late = Unexplained("torque_rate", misread.rms_arcsec, 0.0, misread)
        decision = overruled(late)
    ids = [c.id for c in decision.causes]
    gain, levels = gains_of(explained, ids)
    if (fails := refuted(levels)) is not None:
        decision = overruled(fails, decision.causes, decision.unexplained)
    outcome = DiagnosisOutcome(
        decision.verdict,
        decision.causes,
        decision.unexplained,
        gain,
        after_late(misread) if misread else next_measurement(explained, decision),
        gains_at_levels=levels,
    )
    written = written_model(explained, sweep, ids, gain)
    return outcome, SweepAnalysis(explained, written.model, written.doubt, left.tests)


def _misread(
    prepared: PreparedSweep, explained: ExplainedSweep, decision: Decision
) -> BackwardLoop | LateAngle | None:
    """A reading that comes late, where something was found that may be it."""
    found = None
    # causes that explain all leave no loop to run backwards: where polynomials took slow noise for the
    # curve's, a few loads of a gear that does nothing seem to
    if decision.unexplained:
        found = backward_of(prepared, explained)
    if found is None and (decision.causes or decision.unexplained):
        return late_angle_of(prepared, explained)
    return found


def _insufficient(shortage: Shortage) -> DiagnosisOutcome:
    whole = NextMeasurement("torque_Nm", "more_data", doing=Doing("whole_sweeps"))
    return DiagnosisOutcome(
        "insufficient",
        next_measurement=whole,
        too_little=shortage,
    )
