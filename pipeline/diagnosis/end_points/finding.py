"""What is found in end points, with all that a figure or a report needs."""

from __future__ import annotations

from dataclasses import dataclass

from flexspline.pipeline.diagnosis.calibration import Calibration
from flexspline.pipeline.diagnosis.end_points.envelope import Envelope, Explanation
from flexspline.pipeline.diagnosis.end_points.race import Hypothesis
from flexspline.pipeline.diagnosis.plans import PlanSeparation

CORRECTED_P_VALUE = 0.05
"""A unit is beyond the envelope where its p-value, corrected for all units looked at, is below this."""


@dataclass(frozen=True)
class UnitFinding:
    """One unit against the envelope, at the torque where it is furthest out.

    `z` is its distance in standard deviations, `p_value` two-sided and exact (the play's end
    included), `p_corrected` for all units and torques looked at (Šidák).
    """

    unit: str
    torque_Nm: float
    total_arcsec: float
    predicted_arcsec: float
    std_arcsec: float
    mid_arcsec: float
    z: float
    p_value: float
    p_corrected: float
    explanation: Explanation

    @property
    def within(self) -> bool:
        """Whether the design's uncertainty covers it."""
        return self.p_corrected >= CORRECTED_P_VALUE


@dataclass(frozen=True)
class MidPositions:
    """Where the units' mid positions lie [arcsec], one for each unit.

    `asymmetry_reach_arcsec` is the furthest that stiffness differing with direction could move one:
    all twist on one side. A zero of the angle, free for each unit, could move one anywhere.
    """

    mid_arcsec: tuple[float, ...]
    asymmetry_reach_arcsec: float


@dataclass(frozen=True)
class EndPointAnalysis:
    """The whole comparison.

    `envelopes`: of each torque. `units`: each unit at its worst. `common` (mean, std): the gap's
    deviation that all units share [arcsec]; `share`: how much of the gap's stated variance is common.
    `reading_arcsec`: standard deviation of a total. `hypotheses`: the race, likeliest first.
    `plans`: further measurements by what they separate, best first. `several_torques`: whether some unit
    was measured at more than one torque. `calibration`: the gap common to all units, beside what was found.
    `race_rows`: rows on which the hypotheses were compared.
    """

    envelopes: tuple[Envelope, ...]
    units: tuple[UnitFinding, ...]
    mids: MidPositions
    common: tuple[float, float]
    share: float
    reading_arcsec: float
    hypotheses: tuple[Hypothesis, ...]
    plans: tuple[PlanSeparation, ...]
    several_torques: bool
    calibration: Calibration
    race_rows: int

    def envelope_at(self, torque_Nm: float) -> Envelope:
        """Of one of the file's torques."""
        return next(e for e in self.envelopes if e.torque_Nm == torque_Nm)
