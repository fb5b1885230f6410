"""What a slope far from the simulated one may come from besides the gear: a unit, or a complete gear."""

from __future__ import annotations

from dataclasses import dataclass
from math import log

from flexspline.pipeline.diagnosis.measurement.columns import ReadColumn
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.units import ANGLE, TORQUE, Factors
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.sweep.size import SweepSize, sweep_size

NEAR = 0.05
"""Of a unit's factor, relative: Young's modulus and a solver's mesh are known to some 2 % each."""
CHORD_NEAR = 0.3
"""The same of the twist with the gap in it, which is stated to 10 to 20 %."""
AS_GEAR = 1.5
"""Times softer than flexspline and shaft from which a complete gear is as likely as a fault. At small torque
its few teeth in mesh and its bearing yield twice what the two parts do (docs/whole-gear.md)."""
ANGLE_UNITS, TORQUE_UNITS = ("arcsec", "arcmin", "deg", "mrad", "rad"), ("Nm", "mNm", "Ncm", "kNm")
"""Units that rigs use and this program reads; others are not guessed at."""
TORQUES: Factors = {unit: TORQUE[unit] for unit in TORQUE_UNITS} | {
    "in·lb": 0.112985, "ft·lb": 1.355818, "kgf·m": 9.80665, "kgf·cm": 0.0980665, "oz·in": 0.00706155,
}  # fmt: skip
"""N·m of one, NIST SP 811 (2008), appendix B.8."""
ANGLES: Factors = {unit: ANGLE[unit] for unit in ANGLE_UNITS}


@dataclass(frozen=True)
class UnitHint:
    """The slope differs by just the ratio of two units: the column's, and another one."""

    head: str
    unit: str
    other: str


@dataclass(frozen=True)
class SlopeHint:
    """A slope `softer` times softer than simulated, and the units that would explain it just so.

    Without any it may be a complete gear's, which the sum of two parts is not.
    """

    softer: float
    units: tuple[UnitHint, ...] = ()


def slope_hint(sweep: Sweep, prediction: Prediction) -> SlopeHint | None:
    """What the slope may come from; None where it is near the simulated one, or no unit's factor stiffer."""
    if not len(sweep.history):
        return None
    size = sweep_size(sweep.history, sweep.angle_arcsec, prediction)
    if size is None or size.compliance <= 0:
        return None
    units = unit_hints(size, sweep)
    soft = size.compliance_range[0] > AS_GEAR and prediction.bend is None
    return SlopeHint(size.compliance, units) if units or soft else None


def unit_hints(size: SweepSize, sweep: Sweep) -> tuple[UnitHint, ...]:
    """Units in which the slope would be as simulated, within `NEAR`."""
    found: list[UnitHint] = []
    torque, angle = (sweep.read_as.column(name) for name in ("torque", "angle"))
    if torque is not None and size.compliance > 0:
        found += _hints(torque, TORQUES, size.compliance)
    if angle is not None and size.compliance > 0 and size.chord > 0:
        off = abs(log(size.chord / size.compliance))
        found += _hints(angle, ANGLES, 1 / size.compliance) if off < CHORD_NEAR else []
    return tuple(found)


def _hints(column: ReadColumn, factors: Factors, ratio: float) -> list[UnitHint]:
    """Units worth `ratio` of the column's, but its own."""
    wanted = column.factor * ratio
    return [
        UnitHint(column.head, column.unit, unit)
        for unit, factor in factors.items()
        if abs(log(factor / wanted)) < NEAR < abs(log(factor / column.factor))
    ]
