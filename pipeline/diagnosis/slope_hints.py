"""Likely reasons for a slope far from the simulated one: a wrong unit, or a complete gear on the rig."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, log

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.measurement.columns import ReadColumn
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.units import (
    ANGLE,
    TORQUE,
    Factors,
    symbol,
)
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.structure import UnitSuspect
from flexspline.pipeline.diagnosis.sweep.twist_ratio import SweepSize, sweep_size

NEAR_FACTOR = 0.05
"""Relative distance from a unit's factor. Young's modulus and a solver's mesh are known to some 2 % each."""
CHORD_NEAR = 0.3
"""The same of the twist with the gap in it, which is stated to 10 to 20 %."""
AS_GEAR = 1.5
"""Times softer than flexspline and shaft from which a complete gear is as likely as a fault. At small torque
its few teeth in mesh and its bearing yield twice what the two parts do (docs/whole-gear.md)."""
BACK_SHARE = 0.3
"""Of the simulated gap, by which the angle steps back where torque changes sign, if the two are interchanged.
Friction's and a late reading's steps differ in sign between up and down. Judgement."""
DEVIATIONS = 3.0
"""Standard deviations of a named compliance on either side; one in 370 lies beyond."""
ANGLE_UNITS, TORQUE_UNITS = ("arcsec", "arcmin", "deg", "mrad", "rad"), ("Nm", "mNm", "Ncm", "kNm")
"""Units that rigs use; others are not guessed at."""
TORQUES: Factors = {
    unit: TORQUE[unit] for unit in (*TORQUE_UNITS, "in_lbf", "ft_lbf", "kgf_m", "kgf_cm", "in_ozf")
}
ANGLES: Factors = {unit: ANGLE[unit] for unit in ANGLE_UNITS}


@dataclass(frozen=True)
class SlopeRatio:
    """Measured over simulated compliance, and the least and largest ratio that the record allows."""

    ratio: float
    low: float
    high: float

    @property
    def sharp(self) -> bool:
        """Whether it is known as well as the simulated one is: to `NEAR_FACTOR`."""
        return self.low > 0 and max(self.high / self.ratio, self.ratio / self.low) < 1 + NEAR_FACTOR

    @property
    def far(self) -> bool:
        """Whether it lies farther off than a fault of the gear is likely to bring it."""
        return self.low > AS_GEAR or self.high < 1 / AS_GEAR

    def spans(self, factor: float) -> bool:
        """Whether the ratio may be `factor`; `NEAR_FACTOR` and the record's own range in quadrature."""
        if self.low <= 0:
            return False
        end = self.high if factor > self.ratio else self.low
        return abs(log(factor / self.ratio)) < hypot(log(end / self.ratio), NEAR_FACTOR)


@dataclass(frozen=True)
class SlopeHint:
    """A slope softer or stiffer than simulated by a ratio, and the units that would explain it just so.

    `interchanged` : it is as simulated where each reading is the other. `whole_gear` : it may be a complete
    gear's, which the sum of two parts is not. Else it is far from the simulated one, and nothing says why.
    """

    slope: SlopeRatio
    units: tuple[UnitSuspect, ...] = ()
    interchanged: bool = False
    whole_gear: bool = False


def slope_hint(
    sweep: Sweep,
    prediction: Prediction,
    causes: Sequence[NamedCause] = (),
    negative_gap: bool = False,
) -> SlopeHint | None:
    """What the slope may come from; None where it is near the simulated one, or named, and no unit's factor.

    `causes` : those named. Series compliance among them is the slope, with friction and temperature allowed
    for; else the slope is a straight line's. So it is where hardening is named too: the two share the slope
    in a proportion that the record leaves open, and a compliance of 148 ± 53 % says nothing of their sum.
    `negative_gap` : the best explanation needs one, as readings that are interchanged do.
    """
    if not len(sweep.history):
        return None
    size = sweep_size(sweep.history, sweep.angle_arcsec, prediction)
    if size is None:
        return None
    named = [c for c in causes if c.id == SERIES]
    if any(c.own_units for c in named):  # a unit of measurement is all units' under test
        return None
    shared = any(c.id == HARDENING for c in causes)
    slope = _named_slope(named[0]) if named and not shared else _line_slope(size)
    if slope.ratio <= 0:
        return None
    units = unit_hints(size, sweep, slope)
    swapped = _may_be_interchanged(size, negative_gap)
    soft = slope.low > AS_GEAR and prediction.bend is None
    unsaid = slope.far and not any(known_causes()[c.id].elastic for c in causes)
    if not (units or swapped or soft or unsaid):
        return None
    return SlopeHint(slope, units, swapped, soft)


def slope_off(sweep: Sweep, prediction: Prediction) -> SlopeRatio | None:
    """A straight line's slope where it is surely not the simulated one; None else."""
    size = sweep_size(sweep.history, sweep.angle_arcsec, prediction) if len(sweep.history) else None
    if size is None:
        return None
    slope = _line_slope(size)
    allowed = DEVIATIONS * prediction.compliance_std / prediction.compliance + NEAR_FACTOR
    return slope if slope.low > 1 + allowed or 0 < slope.high < 1 - allowed else None


def _may_be_interchanged(size: SweepSize, negative_gap: bool) -> bool:
    """Whether a slope far from the simulated one is near it where each reading is the other.

    And nothing says that it is not: readings in their columns make the angle step on at the gap.
    """
    other = size.interchanged
    if size.gap_arcsec < -BACK_SHARE * size.simulated_gap_arcsec and size.steps_back:
        return 1 / AS_GEAR < other < AS_GEAR  # the gap as it is along the other axis
    if size.steps_on or not 1 / AS_GEAR < other < AS_GEAR:
        return False
    return negative_gap or (_line_slope(size).far and abs(log(other)) < abs(log(size.compliance)))


def unit_hints(
    size: SweepSize, sweep: Sweep, slope: SlopeRatio | None = None
) -> tuple[UnitSuspect, ...]:
    """Units in which the slope would be as simulated, within `NEAR_FACTOR` and its own range.

    None of a slope that is known roughly and may be a fault's.
    """
    slope = slope or _line_slope(size)
    if slope.ratio <= 0 or not (slope.sharp or slope.far):
        return ()
    hints: list[UnitSuspect] = []
    torque, angle = (sweep.read_as.column(name) for name in ("torque", "angle"))
    if torque is not None:
        hints += _hints(torque, TORQUES, slope, 1)
    if angle is not None and size.chord > 0:
        off = abs(log(size.chord / slope.ratio))
        hints += _hints(angle, ANGLES, slope, -1) if off < CHORD_NEAR else []
    return tuple(hints)


def _named_slope(series: NamedCause) -> SlopeRatio:
    ratio, off = 1 + series.magnitude / 100, DEVIATIONS * series.magnitude_std / 100
    return SlopeRatio(ratio, ratio - off, ratio + off)


def _line_slope(size: SweepSize) -> SlopeRatio:
    return SlopeRatio(size.compliance, *size.compliance_range)


def _hints(
    column: ReadColumn, factors: Factors, slope: SlopeRatio, power: int
) -> list[UnitSuspect]:
    """Units but the column's own; the slope goes with their factor to the `power`."""
    return [
        UnitSuspect(column.head, symbol(unit), symbol(column.unit))
        for unit, factor in factors.items()
        if slope.spans((factor / column.factor) ** power)
        and abs(log(factor / column.factor)) > NEAR_FACTOR
    ]
