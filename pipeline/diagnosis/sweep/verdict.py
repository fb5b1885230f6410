"""A record explained by causes, and the verdict on it: `judge` has the steps in order.

Errors on held-out data, which may overrule the verdict, come later (`diagnose.py`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot

from flexspline.pipeline.diagnosis.decision import Decision, decided, overruled
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.thinning import thinned
from flexspline.pipeline.diagnosis.outcome import NamedCause, Unexplained
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.shortage import FewRows, Shortage
from flexspline.pipeline.diagnosis.structure import (
    BackwardLoop,
    DraggedCrossing,
    FarSlope,
    LateAngle,
)
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import (
    PreparedSweep,
    TooFewRowsError,
    prepare,
)
from flexspline.pipeline.diagnosis.sweep.identification.gear_curve_error import lost_bend
from flexspline.pipeline.diagnosis.sweep.named_causes import named_causes
from flexspline.pipeline.diagnosis.sweep.physical_limits import broken_limit, drowned, slow_noise
from flexspline.pipeline.diagnosis.sweep.race.friction_ahead_race import with_friction_ahead
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep, run_race
from flexspline.pipeline.diagnosis.sweep.race.torque_offset_race import with_torque_offset
from flexspline.pipeline.diagnosis.sweep.residual.nuisance_share import unnamed_share
from flexspline.pipeline.diagnosis.sweep.residual.residual_structure import (
    ResidualStructure,
    residual_structure,
)
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import UNKNOWN_P_VALUE
from flexspline.pipeline.diagnosis.sweep.residual.unexplained import (
    made_by_rounding,
    unexplained_of,
)
from flexspline.pipeline.diagnosis.sweep.rig_faults.backward_loops import backward_of
from flexspline.pipeline.diagnosis.sweep.rig_faults.dragged_crossing import dragged_crossing_of
from flexspline.pipeline.diagnosis.sweep.rig_faults.late_angle import late_angle_of
from flexspline.pipeline.diagnosis.sweep.too_few_torques import too_few_torques


@dataclass(frozen=True)
class JudgedSweep:
    """A record, its best explanation, what that leaves, and the verdict.

    `misread` : a reading that comes late, or drag that looks like one, where the record shows it.
    """

    sweep: Sweep
    explained: ExplainedSweep
    left: ResidualStructure
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
    decision = _on_causes(explained, causes, left)
    broken = broken_limit(sweep, explained, decision.causes)  # physical_limits.py
    if broken is not None:
        decision = overruled(broken, beside=decision.unexplained)  # ../decision.py
    if decision.verdict == "consistent":
        slow = slow_noise(explained)  # physical_limits.py
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


def _on_causes(
    explained: ExplainedSweep, causes: Sequence[NamedCause], left: ResidualStructure
) -> Decision:
    """The verdict on the causes named, by what they and what is left explain."""
    identified = explained.identified
    attributed = {name for c in causes for name in (c.id, *c.alternatives)}
    if not causes:  # beside one, which may be a part of the saw-tooth, it stays unexplained
        attributed |= made_by_rounding(identified, left.rounding_arcsec)  # residual/unexplained.py
    named_rms = hypot(*(c.rms_arcsec for c in causes))
    lost = lost_bend(identified.fit)  # identification/gear_curve_error.py
    nuisance = unnamed_share(identified, attributed)  # residual/nuisance_share.py
    unnamed_rms = hypot(
        identified.unnamed_rms(attributed),
        *(s.rms_arcsec for s in (left.jumps, left.lack_of_fit) if s is not None),
        lost.rms if lost else 0.0,
    )
    unexplained = unexplained_of(  # residual/unexplained.py
        identified,
        left.tests,
        left.jumps,
        left.lack_of_fit,
        attributed,
        explained.prepared.sweep.units,
    )
    return decided(  # ../decision.py
        tuple(causes),
        (*([lost] if lost else []), *unexplained),
        named_rms=named_rms,
        unnamed_rms=max(unnamed_rms, nuisance * named_rms),
        structure=any(t.p_value < UNKNOWN_P_VALUE for t in left.tests),
    )


def _misread(
    prepared: PreparedSweep, explained: ExplainedSweep, decision: Decision
) -> BackwardLoop | LateAngle | DraggedCrossing | None:
    """A reading that comes late, or drag, where something was found that may be it."""
    backward = None
    # causes that explain all leave no loop to run backwards: where polynomials took slow noise for the
    # curve's, a few loads of a gear that does nothing seem to
    if decision.unexplained:
        backward = backward_of(prepared, explained)  # rig_faults/backward_loops.py
    if backward is None and (decision.causes or decision.unexplained):
        late = late_angle_of(prepared, explained)  # rig_faults/late_angle.py
        if late is not None:
            return late
        causes = decision.causes
        return dragged_crossing_of(prepared, explained, causes)  # rig_faults/dragged_crossing.py
    return backward
