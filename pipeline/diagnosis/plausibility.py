"""Sizes that no gear has: a measurement absurd against its design is refused with the likely reason."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

import numpy as np

from flexspline.pipeline.backlash import series_stiffness
from flexspline.pipeline.diagnosis.absurd_size import (
    Absurd,
    FallingAngle,
    FarReading,
    FarTwist,
    Still,
    absurd_words,
)
from flexspline.pipeline.diagnosis.measurement.columns import ReadColumn
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.floors import ROUNDING_OF_SUMS
from flexspline.pipeline.diagnosis.measurement.record import (
    EndPoints,
    Measurement,
    Specimens,
    Sweep,
)
from flexspline.pipeline.diagnosis.measurement.units import (
    ANGLE,
    STIFFNESS,
    TORQUE,
    Factors,
    symbol,
)
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.slope_hints import (
    ANGLE_UNITS,
    AS_GEAR,
    TORQUE_UNITS,
    unit_hints,
)
from flexspline.pipeline.diagnosis.structure import FarSlope, UnitSuspect
from flexspline.pipeline.diagnosis.sweep.twist_ratio import SweepSize, sweep_size

ABSURD_RATIO = 30.0
"""Times stiffer or softer than simulated, docs/contract.md, section 4."""
LIKELY_RATIO = 3.0
"""Factor by which readings in the likely unit may be off. A real gear's twist is within it. Judgement."""
RESOLVED_RATIO = 10.0
"""Twist of a slope over the rms residual of its line, at least. A curve through the gap is not a slope."""
POSITION_ERROR_arcsec = 120.0
"""Readings wander so far without torque: catalogues allow small wave gears 2 arcmin of position error."""
NO_SIGNAL_SHARE = 1e-3
"""Share of the simulated twist. A smaller twist may come from a channel without a signal as well as from a
wrong unit. Judgement."""
AS_LIKELY_RATIO = 1.5
"""A unit is also suggested if its ratio is off by this factor more than the best unit's. Judgement."""
LEAST_RATIO = 1e-12
"""Smallest ratio whose logarithm is taken."""
OPPOSITE_SHARE = -1 / 3
"""Least twist in the wrong direction over the simulated twist. No friction or drift reverses so much.
Judgement."""


def refuse_absurd(
    measurement: Measurement,
    prediction: Prediction,
    K_b: float,
    K_e: float,
    given: Collection[str] = (),
) -> None:
    """Refuse a measurement whose size cannot be the design's; K in N·m/rad.

    `given`: the stiffnesses that a person stated, such as `--Kb 31.3`: these are doubted too.

    Raises
    ------
    MeasurementError : more than 30 times softer or stiffer, or the sign turned; with the likely unit.
    """
    if isinstance(measurement, Sweep):
        size = sweep_size(measurement.history, measurement.angle_arcsec, prediction)
        absurd = None if size is None else absurd_sweep(size, measurement)
    elif isinstance(measurement, EndPoints):
        absurd = _absurd_end_points(measurement, prediction)
    else:
        absurd = _absurd_specimens(measurement, K_b, K_e)
    if absurd is not None:
        raise MeasurementError(measurement.path, None, absurd_words(absurd, given))


def absurd_sweep(size: SweepSize, sweep: Sweep) -> Absurd | None:
    """What is absurd of the size of a sweep; None where nothing is."""
    if np.ptp(sweep.angle_arcsec) == 0:
        return Still()
    low, high = size.chord_range
    if (
        low > ABSURD_RATIO
        or high < -ABSURD_RATIO
        or -1 / ABSURD_RATIO < low <= high < 1 / ABSURD_RATIO
    ):
        return _far_twist(size.chord, size, sweep)
    if high < OPPOSITE_SHARE:
        return FallingAngle("sweep")
    if far_interchanged(size) and size.steps_back:
        return replace(far_slope(size, sweep), interchanged=True)
    if size.span_arcsec > ABSURD_RATIO * (size.simulated_arcsec + POSITION_ERROR_arcsec):
        return _far_twist(size.span_arcsec / size.simulated_arcsec, size, sweep)
    return far_slope(size, sweep) if slope_beyond(size, ABSURD_RATIO) else None


def slope_beyond(size: SweepSize, limit: float) -> bool:
    """Whether the slope is surely `limit` times softer or stiffer than simulated."""
    least, most = size.compliance_range
    if least > limit:
        return size.elastic_arcsec > RESOLVED_RATIO * size.residual_arcsec
    simulated = size.elastic_arcsec / max(abs(size.compliance), 1e-3 / limit)
    return most < 1 / limit and simulated > RESOLVED_RATIO * size.residual_arcsec


def far_slope(size: SweepSize, sweep: Sweep) -> FarSlope:
    """How much stiffer or softer the gear would be, and why that may seem so."""
    connected = abs(size.chord) >= NO_SIGNAL_SHARE
    return FarSlope(size.compliance, suspects(size, sweep), connected, _interchanged(size, sweep))


def _far_twist(ratio: float, size: SweepSize, sweep: Sweep) -> FarTwist:
    column = sweep.read_as.column("angle")
    head = column.head if column else ""
    connected = abs(size.chord) >= NO_SIGNAL_SHARE
    return FarTwist(ratio, suspects(size, sweep), connected, _interchanged(size, sweep), head)


def far_interchanged(size: SweepSize) -> bool:
    """Whether the slope is surely as no gear's, and as simulated where each reading is the other."""
    least, most = size.compliance_range
    far = least > LIKELY_RATIO or most < 1 / LIKELY_RATIO
    return far and 1 / AS_GEAR < size.interchanged < AS_GEAR


def _interchanged(size: SweepSize, sweep: Sweep) -> bool:
    """Whether the twist is as simulated, within `LIKELY_RATIO`, where each reading is the other."""
    torques = float(np.ptp(sweep.history.torque_Nm))
    elastic = (size.simulated_arcsec - size.simulated_gap_arcsec) * size.span_arcsec / torques
    if elastic <= size.simulated_gap_arcsec:  # a dead channel, whose rest is the gap
        return False
    ratio = torques / (elastic + size.simulated_gap_arcsec)
    return 1 / LIKELY_RATIO < ratio < LIKELY_RATIO


def suspects(size: SweepSize, sweep: Sweep) -> tuple[UnitSuspect, ...]:
    """Units in which the readings would be right, the likeliest first."""
    angle, torque = (sweep.read_as.column(name) for name in ("angle", "torque"))
    suspected: list[tuple[float, UnitSuspect]] = []
    if angle:
        if abs(size.chord) > 1 and _whole(sweep.angle_arcsec / angle.factor):
            suspected.append((0.0, UnitSuspect(angle.head)))
        for unit, off in likely_units((size.chord, size.compliance), angle, ANGLE_UNITS, ANGLE):
            suspected.append((off, UnitSuspect(angle.head, unit, symbol(angle.unit))))
    if torque and size.compliance:
        for unit, off in likely_units((1 / size.compliance,), torque, TORQUE_UNITS, TORQUE):
            elastic = size.simulated_arcsec - size.simulated_gap_arcsec
            simulated = elastic * TORQUE[unit] / torque.factor + size.simulated_gap_arcsec
            chord = float(
                np.log(max(abs(size.chord), LEAST_RATIO) * size.simulated_arcsec / simulated)
            )
            if abs(chord) < np.log(LIKELY_RATIO):
                off = max(off, abs(chord))
                suspected.append((off, UnitSuspect(torque.head, unit, symbol(torque.unit))))
    suspected += [(0.0, hint) for hint in unit_hints(size, sweep)]
    best = min((off for off, _ in suspected), default=0.0)
    likely = (one for off, one in sorted(suspected) if off <= best + np.log(AS_LIKELY_RATIO))
    return tuple(dict.fromkeys(likely))


def likely_units(
    ratios: tuple[float, ...], column: ReadColumn, units: tuple[str, ...], factors: Factors
) -> list[tuple[str, float]]:
    """Units in which readings `ratios` times too large are right within `LIKELY_RATIO`; how far off in ln."""
    size = np.clip(np.abs(ratios), LEAST_RATIO, 1 / LEAST_RATIO)
    off = {u: float(np.abs(np.log(size * factors[u] / column.factor)).max()) for u in units}
    return [(u, off[u]) for u in units if u != column.unit and off[u] < np.log(LIKELY_RATIO)]


def likely_unit(
    ratio: float, column: ReadColumn | None, units: tuple[str, ...], factors: Factors
) -> str:
    """The likeliest of them, "" for none."""
    likely = likely_units((ratio,), column, units, factors) if column else []
    return min(likely, key=lambda pair: pair[1])[0] if likely else ""


def _suspect(column: ReadColumn | None, unit: str) -> UnitSuspect | None:
    """The column in that unit; None where there is no column or no likely unit."""
    if column is None or not unit:
        return None
    return UnitSuspect(column.head, unit, symbol(column.unit))


def _whole(readings: np.ndarray) -> bool:
    """Whether all readings are whole numbers; those that went through a factor to ours, nearly."""
    return bool(
        np.all(np.abs(readings - np.round(readings)) <= ROUNDING_OF_SUMS * np.abs(readings))
    )


def _beyond(ratio: float) -> bool:
    return ratio > ABSURD_RATIO or ratio < 1 / ABSURD_RATIO


def _absurd_end_points(points: EndPoints, prediction: Prediction) -> Absurd | None:
    simulated = prediction.twist_arcsec(-points.torque_Nm, points.torque_Nm)
    if not np.all(simulated > 0):
        return None
    ratio = float(np.median(points.total_arcsec / simulated))
    if _beyond(abs(ratio)):
        column = points.read_as.column("angle_plus")
        unit = likely_unit(ratio, column, ANGLE_UNITS, ANGLE)
        return FarReading("end_points", ratio, _suspect(column, unit))
    return FallingAngle("end_points") if ratio < OPPOSITE_SHARE else None


def _absurd_specimens(specimens: Specimens, K_b: float, K_e: float) -> Absurd | None:
    stiffness = {"flexspline": K_b, "shaft": K_e, "series": series_stiffness(K_b, K_e)}
    parts: Iterable[tuple[str, ...]] = (specimens.part,)
    if not specimens.part_recorded:
        parts = ((name,) * len(specimens.part) for name in stiffness)
    ratios = [
        float(np.median(specimens.stiffness_Nm_per_rad / np.array([stiffness[p] for p in part])))
        for part in parts
    ]
    if not all(_beyond(r) for r in ratios):
        return None
    ratio = min(ratios, key=lambda r: abs(np.log(r)))
    column = specimens.read_as.column("stiffness")
    unit = likely_unit(ratio, column, tuple(STIFFNESS), STIFFNESS)
    head = column.head if column else ""
    return FarReading("specimens", ratio, _suspect(column, symbol(unit) if unit else ""), head)
