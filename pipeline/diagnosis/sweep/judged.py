"""A record explained by causes, and the verdict on it; what the causes are worth elsewhere comes later."""

from __future__ import annotations

from dataclasses import dataclass

from flexspline.pipeline.diagnosis.decision import Decision, overruled
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.thinning import thinned
from flexspline.pipeline.diagnosis.outcome import Unexplained
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.shortage import FewRows, Shortage
from flexspline.pipeline.diagnosis.structure import BackwardLoop, FarSlope, LateAngle
from flexspline.pipeline.diagnosis.sweep.ahead_race import with_friction_ahead
from flexspline.pipeline.diagnosis.sweep.backward import backward_of
from flexspline.pipeline.diagnosis.sweep.late_angle import late_angle_of
from flexspline.pipeline.diagnosis.sweep.left_over import LeftOver, judged, left_over
from flexspline.pipeline.diagnosis.sweep.limits import broken_limit, drowned, slow_noise
from flexspline.pipeline.diagnosis.sweep.named_causes import named_causes
from flexspline.pipeline.diagnosis.sweep.offset_race import with_torque_offset
from flexspline.pipeline.diagnosis.sweep.prepare import PreparedSweep, TooFewRowsError, prepare
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep, run_race
from flexspline.pipeline.diagnosis.sweep.too_few_torques import too_few_torques


@dataclass(frozen=True)
class JudgedSweep:
    """A record, its best explanation, what that leaves, and the verdict.

    `misread` : a reading that comes late, where that is what the record shows.
    """

    sweep: Sweep
    explained: ExplainedSweep
    left: LeftOver
    decision: Decision
    misread: BackwardLoop | LateAngle | None


def judge(sweep: Sweep, prediction: Prediction) -> JudgedSweep | Shortage:
    """The verdict on a record; why there is none where rows are too few or drowned in noise."""
    shortage = too_few_torques(sweep)
    if shortage is not None:
        return shortage
    try:
        prepared = prepare(thinned(sweep), prediction)
    except TooFewRowsError as error:
        return FewRows(error.count, error.wanted)
    explained = with_friction_ahead(prepared) or with_torque_offset(run_race(prepared))
    if (hidden := drowned(explained)) is not None:
        return hidden
    causes = named_causes(explained)
    left = left_over(explained)
    decision = judged(explained, causes, left)
    broken = broken_limit(sweep, explained, decision.causes)
    if broken is not None:
        decision = overruled(broken, beside=decision.unexplained)
    if decision.verdict == "consistent" and (slow := slow_noise(explained)) is not None:
        decision = overruled(slow)
    misread = None
    if broken is None or not isinstance(
        broken.structure, FarSlope
    ):  # a wrong unit or column bends all
        misread = _misread(prepared, explained, decision)
    if misread is not None:  # whatever else was found is what the race made of it
        late = Unexplained("torque_rate", misread.rms_arcsec, 0.0, misread)
        decision = overruled(late)
    return JudgedSweep(sweep, explained, left, decision, misread)


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
