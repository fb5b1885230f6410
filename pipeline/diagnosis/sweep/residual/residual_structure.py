"""Structure that the best explanation leaves in a record's residual."""

from __future__ import annotations

from dataclasses import dataclass

from flexspline.pipeline.diagnosis.sweep.identification.gear_curve_error import (
    OVER_TORQUE,
    curve_doubt_arcsec,
)
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.residual.lack_of_fit import repeated_misfit
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import (
    ChannelTest,
    channel_tests,
)
from flexspline.pipeline.diagnosis.sweep.residual.rounding import (
    rounding_left_arcsec,
    rounding_of_torque,
)
from flexspline.pipeline.diagnosis.sweep.residual.stick_slip_rests import stuck_of
from flexspline.pipeline.diagnosis.sweep.residual.stick_slip_skewness import (
    Jumps,
    jumps_of,
    largest,
)
from flexspline.pipeline.diagnosis.sweep.residual.stick_slip_travel import scatter_along_travel


@dataclass(frozen=True)
class ResidualStructure:
    """Structure in the residual that is more than the rounding of the readings, or a curve's own doubt.

    Attributes
    ----------
    tests : of every channel.
    jumps : with the torque's motion.
    lack_of_fit : the misfit that comes back in every cycle.
    rounding_arcsec : what rounding leaves.
    """

    tests: tuple[ChannelTest, ...]
    jumps: Jumps | None
    lack_of_fit: ChannelTest | None
    rounding_arcsec: float


def residual_structure(explained: ExplainedSweep) -> ResidualStructure:
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
    lack_of_fit = repeated_misfit(prepared, fit)
    if lack_of_fit is not None and lack_of_fit.rms_arcsec < of_curve:
        lack_of_fit = None
    return ResidualStructure(tuple(tests), jumps, lack_of_fit, rounding)
