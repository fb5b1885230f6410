"""What the best explanation leaves of a record, and the verdict that it and the causes make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot

from flexspline.pipeline.diagnosis.decision import Decision, decided
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.sweep.credit import unnamed_share
from flexspline.pipeline.diagnosis.sweep.curve_doubt import (
    OVER_TORQUE,
    curve_doubt_arcsec,
    lost_bend,
)
from flexspline.pipeline.diagnosis.sweep.jumps import Jumps, jumps_of, largest
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.repeated_misfit import repeated_misfit
from flexspline.pipeline.diagnosis.sweep.residual_tests import (
    UNKNOWN_P_VALUE,
    ChannelTest,
    channel_tests,
)
from flexspline.pipeline.diagnosis.sweep.rounding import (
    rounding_left_arcsec,
    rounding_of_torque,
)
from flexspline.pipeline.diagnosis.sweep.stuck import stuck_of
from flexspline.pipeline.diagnosis.sweep.travel_scatter import scatter_along_travel
from flexspline.pipeline.diagnosis.sweep.unexplained import made_by_rounding, unexplained_of


@dataclass(frozen=True)
class LeftOver:
    """Structure in the residual that is more than the rounding of the readings, or a curve's own doubt.

    Attributes
    ----------
    tests : of every channel. jumps : with the torque's motion. again : the misfit that comes back in every
        cycle. rounding_arcsec : what rounding leaves.
    """

    tests: tuple[ChannelTest, ...]
    jumps: Jumps | None
    again: ChannelTest | None
    rounding_arcsec: float


def left_over(explained: ExplainedSweep) -> LeftOver:
    """What the best set of a race leaves."""
    prepared, fit = explained.prepared, explained.identified.fit
    rounding = rounding_left_arcsec(prepared, fit)
    torque = prepared.rig.history.torque_Nm[fit.evidence.kept]
    of_curve = max(rounding, curve_doubt_arcsec(prepared.prediction, torque))
    tests = [
        t
        for t in channel_tests(prepared, fit)
        if t.rms_arcsec > (of_curve if t.channel in OVER_TORQUE else rounding)
    ]
    jumps = largest(*(test(prepared, fit) for test in (jumps_of, stuck_of, scatter_along_travel)))
    # the encoder's step is known to each of these tests
    if jumps is not None and jumps.rms_arcsec < rounding_of_torque(prepared, fit).left_arcsec:
        jumps = None
    again = repeated_misfit(prepared, fit)
    if again is not None and again.rms_arcsec < of_curve:
        again = None
    return LeftOver(tuple(tests), jumps, again, rounding)


def judged(explained: ExplainedSweep, causes: Sequence[NamedCause], left: LeftOver) -> Decision:
    """The verdict on the causes named, by what they and what is left explain."""
    identified = explained.identified
    told = {name for c in causes for name in (c.id, *c.alternatives)}
    if not causes:  # beside one, which may be a part of the saw-tooth, it stays unexplained
        told |= made_by_rounding(identified, left.rounding_arcsec)
    named_rms = hypot(*(c.rms_arcsec for c in causes))
    lost = lost_bend(identified.fit)
    unnamed_rms = hypot(
        identified.unnamed_rms(told),
        *(s.rms_arcsec for s in (left.jumps, left.again) if s is not None),
        lost.rms if lost else 0.0,
    )
    unexplained = unexplained_of(
        identified, left.tests, left.jumps, left.again, told, explained.prepared.sweep.units
    )
    return decided(
        tuple(causes),
        (*([lost] if lost else []), *unexplained),
        named_rms=named_rms,
        unnamed_rms=max(unnamed_rms, unnamed_share(identified, told) * named_rms),
        structure=any(t.p_value < UNKNOWN_P_VALUE for t in left.tests),
    )
