"""A torque sweep, from its rows to a verdict and what follows: the steps in order.

`judge` takes a record's rows to a verdict. `diagnose_sweep` begins with it, lets it judge units that differ
each by its own rows, and tests the causes on held-out data. Beside a step stands its file, which imports
whatever else the step needs. Before all, `../with_stiffness.py` reads the file and `../diagnose.py` refuses
an absurd size. The reasons of the steps: docs/diagnosis.md.
"""

from __future__ import annotations

from flexspline.pipeline.diagnosis.decision import Decision, overruled
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.thinning import thinned
from flexspline.pipeline.diagnosis.outcome import (
    DiagnosisOutcome,
    Doing,
    NextMeasurement,
    Unexplained,
)
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.shortage import FewRows, Shortage
from flexspline.pipeline.diagnosis.structure import FarSlope
from flexspline.pipeline.diagnosis.sweep.analysis import SweepAnalysis
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import TooFewRowsError, prepare
from flexspline.pipeline.diagnosis.sweep.held_out import gains_of, refuted, unpredicted
from flexspline.pipeline.diagnosis.sweep.named_causes import named_causes
from flexspline.pipeline.diagnosis.sweep.next_measurement import after_late, next_measurement
from flexspline.pipeline.diagnosis.sweep.physical_limits import broken_limit, drowned, slow_noise
from flexspline.pipeline.diagnosis.sweep.race.friction_ahead_race import with_friction_ahead
from flexspline.pipeline.diagnosis.sweep.race.race import run_race
from flexspline.pipeline.diagnosis.sweep.race.torque_offset_race import with_torque_offset
from flexspline.pipeline.diagnosis.sweep.residual.residual_structure import residual_structure
from flexspline.pipeline.diagnosis.sweep.separate_units import units_apart
from flexspline.pipeline.diagnosis.sweep.too_few_torques import too_few_torques
from flexspline.pipeline.diagnosis.sweep.verdict import JudgedSweep, misreading, verdict_on
from flexspline.pipeline.diagnosis.sweep.written_model import written_model


def judge(sweep: Sweep, prediction: Prediction) -> JudgedSweep | Shortage:
    """The verdict on a record; why there is none where rows are too few or drowned in noise."""
    shortage = too_few_torques(sweep)  # too_few_torques.py
    if shortage is not None:
        return shortage
    short = thinned(sweep)  # ../measurement/thinning.py
    try:
        prepared = prepare(short, prediction)  # evidence/prepare.py
    except TooFewRowsError as error:
        return FewRows(error.count, error.wanted)
    explained = with_friction_ahead(prepared)  # race/friction_ahead_race.py
    if explained is None:
        plain = run_race(prepared)  # race/race.py
        explained = with_torque_offset(plain)  # race/torque_offset_race.py
    hidden = drowned(explained)  # physical_limits.py
    if hidden is not None:
        return hidden
    causes = named_causes(explained)  # named_causes.py
    left = residual_structure(explained)  # residual/residual_structure.py
    decision = verdict_on(explained, causes, left)  # verdict.py
    broken = broken_limit(sweep, explained, decision.causes)  # physical_limits.py
    if broken is not None:
        decision = overruled(broken, beside=decision.unexplained)  # ../decision.py
    if decision.verdict == "consistent":
        slow = slow_noise(explained)  # physical_limits.py
        if slow is not None:
            decision = overruled(slow)  # ../decision.py
    # a wrong unit or column bends all
    bent = broken is not None and isinstance(broken.structure, FarSlope)
    misread = None
    if not bent:
        misread = misreading(prepared, explained, decision)  # verdict.py
    if misread is not None:
        late = Unexplained("torque_rate", misread.rms_arcsec, 0.0, misread)
        # whatever else was found is what the race made of it
        decision = overruled(late)  # ../decision.py
    return JudgedSweep(sweep, explained, left, decision, misread)


def diagnose_sweep(
    sweep: Sweep, prediction: Prediction
) -> tuple[DiagnosisOutcome, SweepAnalysis | None]:
    """The verdict on a sweep and what stands behind it; None where there are too few data."""
    whole = judge(sweep, prediction)
    if not isinstance(whole, JudgedSweep):
        return _insufficient(whole), None
    apart = units_apart(whole, judge)  # separate_units.py
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
        explained,
        written.model,
        written.doubt,
        shown.left.tests,
        own.causes,
        apart,
        misread=shown.misread is not None,
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
