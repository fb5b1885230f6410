"""A record explained by causes, and the verdict on it; what the causes are worth elsewhere comes later."""

from __future__ import annotations

from dataclasses import dataclass

from flexspline.pipeline.diagnosis.decision import Decision, overruled
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.thinning import thinned
from flexspline.pipeline.diagnosis.outcome import Unexplained
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.shortage import FewRows, Shortage
from flexspline.pipeline.diagnosis.structure import (
    BackwardLoop,
    DraggedCrossing,
    FarSlope,
    LateAngle,
)
from flexspline.pipeline.diagnosis.sweep.ahead_race import with_friction_ahead
from flexspline.pipeline.diagnosis.sweep.backward import backward_of
from flexspline.pipeline.diagnosis.sweep.dragged_crossing import dragged_crossing_of
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

    `misread` : a reading that comes late, or drag that looks like one, where the record shows it.
    """

    sweep: Sweep
    explained: ExplainedSweep
    left: LeftOver
    decision: Decision
    misread: BackwardLoop | LateAngle | DraggedCrossing | None


def judge(sweep: Sweep, prediction: Prediction) -> JudgedSweep | Shortage:
    """The verdict on a record; why there is none where rows are too few or drowned in noise.

    The steps in order, each with its file.
    """
    shortage = too_few_torques(sweep)  # too_few_torques.py
    if shortage is not None:
        return shortage
    short = thinned(sweep)  # ../measurement/thinning.py
    try:
        prepared = prepare(short, prediction)  # prepare.py
    except TooFewRowsError as error:
        return FewRows(error.count, error.wanted)
    explained = with_friction_ahead(prepared)  # ahead_race.py
    if explained is None:
        plain = run_race(prepared)  # race.py
        explained = with_torque_offset(plain)  # offset_race.py
    hidden = drowned(explained)  # limits.py
    if hidden is not None:
        return hidden
    causes = named_causes(explained)  # named_causes.py
    left = left_over(explained)  # left_over.py
    decision = judged(explained, causes, left)  # left_over.py
    broken = broken_limit(sweep, explained, decision.causes)  # limits.py
    if broken is not None:
        decision = overruled(broken, beside=decision.unexplained)  # ../decision.py
    if decision.verdict == "consistent":
        slow = slow_noise(explained)  # limits.py
        if slow is not None:
            decision = overruled(slow)  # ../decision.py
    # a wrong unit or column bends all
    bent = broken is not None and isinstance(broken.structure, FarSlope)
    misread = None if bent else _misread(prepared, explained, decision)
    if misread is not None:
        late = Unexplained("torque_rate", misread.rms_arcsec, 0.0, misread)
        # whatever else was found is what the race made of it
        decision = overruled(late)  # ../decision.py
    return JudgedSweep(sweep, explained, left, decision, misread)


def _misread(
    prepared: PreparedSweep, explained: ExplainedSweep, decision: Decision
) -> BackwardLoop | LateAngle | DraggedCrossing | None:
    """A reading that comes late, or drag, where something was found that may be it."""
    found = None
    # causes that explain all leave no loop to run backwards: where polynomials took slow noise for the
    # curve's, a few loads of a gear that does nothing seem to
    if decision.unexplained:
        found = backward_of(prepared, explained)  # backward.py
    if found is None and (decision.causes or decision.unexplained):
        late = late_angle_of(prepared, explained)  # late_angle.py
        if late is not None:
            return late
        causes = decision.causes
        return dragged_crossing_of(prepared, explained, causes)  # dragged_crossing.py
    return found
