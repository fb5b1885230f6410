"""The verdict on the causes that a record shows, and what says that the record was misread."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot

from flexspline.pipeline.diagnosis.decision import Decision, decided
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.structure import (
    BackwardLoop,
    DraggedCrossing,
    LateAngle,
)
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import (
    PreparedSweep,
)
from flexspline.pipeline.diagnosis.sweep.identification.gear_curve_error import lost_bend
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.residual.nuisance_share import unnamed_share
from flexspline.pipeline.diagnosis.sweep.residual.residual_structure import (
    ResidualStructure,
)
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import UNKNOWN_P_VALUE
from flexspline.pipeline.diagnosis.sweep.residual.unexplained import (
    made_by_rounding,
    unexplained_of,
)
from flexspline.pipeline.diagnosis.sweep.rig_faults.backward_loops import backward_of
from flexspline.pipeline.diagnosis.sweep.rig_faults.dragged_crossing import dragged_crossing_of
from flexspline.pipeline.diagnosis.sweep.rig_faults.late_angle import late_angle_of


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


def verdict_on(
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


def misreading(
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
