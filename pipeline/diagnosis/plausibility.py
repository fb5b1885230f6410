"""Sizes that no gear has: a measurement absurd against its design is refused with the likely reason."""

from __future__ import annotations

from collections.abc import Collection, Iterable

import numpy as np

from flexspline.pipeline.backlash import series_stiffness
from flexspline.pipeline.diagnosis.measurement.columns import ReadColumn
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import EndPoints, Specimens, Sweep
from flexspline.pipeline.diagnosis.measurement.units import (
    ANGLE,
    STIFFNESS,
    TORQUE,
    Factors,
    symbol,
)
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.slope_hints import ANGLE_UNITS, TORQUE_UNITS, unit_hints
from flexspline.pipeline.diagnosis.sweep.size import SweepSize, sweep_size

ABSURD = 30.0
"""Times stiffer or softer than simulated, docs/contract.md, section 4."""
LIKELY_RATIO = 3.0
"""Times that readings in the likely unit may be off: a real gear's twist is within."""
RESOLVED = 10.0
"""Times the rms off the line that a slope's twist must have: a curve through the gap is no slope."""
POSITION_ERROR_arcsec = 120.0
"""Readings wander so far without torque: catalogues allow small wave gears 2 arcmin of position error."""
NOTHING = 1e-3
"""Of the simulated twist: less is a channel without a signal as likely as a unit."""
AS_LIKELY = 1.5
"""Times further off than the best unit, and a unit is still asked for."""
TINY = 1e-12
"""Ratios are cut here, for their logarithms."""
TURNED, CONNECTED = "turned?", "connected?"
"""Ends of refusals that no stiffness explains: a sign, and a reading that never changes."""
OPPOSITE = -1 / 3
"""Of the simulated twist: no friction or drift turns it over."""


def refuse_absurd(
    measurement: Sweep | EndPoints | Specimens,
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
        reason = None if size is None else absurd_sweep(size, measurement)
    elif isinstance(measurement, EndPoints):
        reason = _absurd_end_points(measurement, prediction)
    else:
        reason = _absurd_specimens(measurement, K_b, K_e)
    if reason:
        doubted = "" if reason.endswith((TURNED, CONNECTED)) else given_words(given)
        raise MeasurementError(measurement.path, None, reason + doubted)


def given_words(given: Collection[str]) -> str:
    """A sentence that names the stiffnesses that a person stated; "" of none."""
    return f" Or check the stiffness given: {', '.join(given)} (N·m/rad)." if given else ""


def absurd_sweep(size: SweepSize, sweep: Sweep) -> str | None:
    """Why the size of a sweep is absurd, in one clause; None where it is not."""
    if np.ptp(sweep.angle_arcsec) == 0:
        return f"the angle is the same in all rows: was its channel {CONNECTED}"
    low, high = size.chord_range
    if low > ABSURD or high < -ABSURD or -1 / ABSURD < low <= high < 1 / ABSURD:
        return _twist_words(size.chord, sweep) + suspects(size, sweep)
    if high < OPPOSITE:
        return f"the angle falls where torque rises: is the sign of angle or torque {TURNED}"
    if size.span_arcsec > ABSURD * (size.simulated_arcsec + POSITION_ERROR_arcsec):
        return _twist_words(size.span_arcsec / size.simulated_arcsec, sweep) + suspects(size, sweep)
    return slope_words(size, sweep) if slope_beyond(size, ABSURD) else None


def slope_beyond(size: SweepSize, limit: float) -> bool:
    """Whether the slope is surely `limit` times softer or stiffer than simulated."""
    least, most = size.compliance_range
    if least > limit:
        return size.elastic_arcsec > RESOLVED * size.residual_arcsec
    simulated = size.elastic_arcsec / max(abs(size.compliance), 1e-3 / limit)
    return most < 1 / limit and simulated > RESOLVED * size.residual_arcsec


def slope_words(size: SweepSize, sweep: Sweep) -> str:
    """How much stiffer or softer the gear would be, and why that may seem so."""
    ratio = size.compliance
    stiff = f"{times(1 / ratio)} stiffer" if 0 < ratio < 1 else f"{times(ratio)} softer"
    said = (
        f"the gear would be {stiff} than simulated"
        if ratio > 0
        else "the angle does not follow the torque"
    )
    return said + suspects(size, sweep)


def suspects(size: SweepSize, sweep: Sweep) -> str:
    """Units in which the readings would be right, the likeliest first, as a question."""
    angle, torque = (sweep.read_as.column(name) for name in ("angle", "torque"))
    found: list[tuple[float, str]] = []
    if angle:
        if abs(size.chord) > 1 and _whole(sweep.angle_arcsec / angle.factor):
            found.append((0.0, f"is {angle.head} in counts of an encoder (--counts-per-turn N)"))
        for unit, off in likely_units((size.chord, size.compliance), angle, ANGLE_UNITS, ANGLE):
            found.append((off, f"is {angle.head} in {unit}, not {symbol(angle.unit)}"))
    if torque and size.compliance:
        for unit, off in likely_units((1 / size.compliance,), torque, TORQUE_UNITS, TORQUE):
            elastic = size.simulated_arcsec - size.simulated_gap_arcsec
            simulated = elastic * TORQUE[unit] / torque.factor + size.simulated_gap_arcsec
            chord = float(np.log(max(abs(size.chord), TINY) * size.simulated_arcsec / simulated))
            if abs(chord) < np.log(LIKELY_RATIO):
                off = max(off, abs(chord))
                found.append((off, f"is {torque.head} in {unit}, not {symbol(torque.unit)}"))
    found += [(0.0, f"is {h.head} in {h.other}, not {h.unit}") for h in unit_hints(size, sweep)]
    best = min((off for off, _ in found), default=0.0)
    likely = (words for off, words in sorted(found) if off <= best + np.log(AS_LIKELY))
    asked = list(dict.fromkeys(likely))
    if abs(size.chord) < NOTHING:
        asked.append("was the channel of the angle connected")
    return ": " + (", or ".join(asked) or "are the units of angle and torque right") + "?"


def likely_units(
    ratios: tuple[float, ...], column: ReadColumn, units: tuple[str, ...], factors: Factors
) -> list[tuple[str, float]]:
    """Units in which readings `ratios` times too large are right within `LIKELY_RATIO`; how far off in ln."""
    size = np.clip(np.abs(ratios), TINY, 1 / TINY)
    off = {u: float(np.abs(np.log(size * factors[u] / column.factor)).max()) for u in units}
    return [(u, off[u]) for u in units if u != column.unit and off[u] < np.log(LIKELY_RATIO)]


def likely_unit(
    ratio: float, column: ReadColumn | None, units: tuple[str, ...], factors: Factors
) -> str:
    """The likeliest of them, "" for none."""
    found = likely_units((ratio,), column, units, factors) if column else []
    return min(found, key=lambda pair: pair[1])[0] if found else ""


def times(ratio: float) -> str:
    """A ratio in words: "3440 times", or "1/206 of"."""
    size = abs(ratio)
    if size >= 1:
        return f"{float(f'{size:.3g}'):g} times"
    return f"1/{float(f'{1 / size:.3g}'):g} of" if size > 1e-6 else "next to nothing of"


def _twist_words(ratio: float, sweep: Sweep) -> str:
    column = sweep.read_as.column("angle")
    turned = " with its sign turned" if ratio < 0 else ""
    return f"{column.head if column else 'the angle'} is {times(ratio)} the simulated twist{turned}"


def _whole(readings: np.ndarray) -> bool:
    """Whether all readings are whole numbers; those that went through a factor to ours, nearly."""
    return bool(np.all(np.abs(readings - np.round(readings)) <= 1e-9 * np.abs(readings)))


def _beyond(ratio: float) -> bool:
    return ratio > ABSURD or ratio < 1 / ABSURD


def _absurd_end_points(points: EndPoints, prediction: Prediction) -> str | None:
    simulated = 2 * points.torque_Nm * prediction.compliance + prediction.gap_arcsec
    if not np.all(simulated > 0):
        return None
    ratio = float(np.median((points.angle_plus_arcsec - points.angle_minus_arcsec) / simulated))
    if _beyond(abs(ratio)):
        column = points.read_as.column("angle_plus")
        unit = likely_unit(ratio, column, ANGLE_UNITS, ANGLE)
        ask = (
            f"are they in {unit}, not {symbol(column.unit)}"
            if column and unit
            else "is the unit right"
        )
        return f"the angles are {times(ratio)} the simulated ones: {ask}?"
    if ratio < OPPOSITE:
        return f"angle_plus lies below angle_minus: are the two columns, or the sign, {TURNED}"
    return None


def _absurd_specimens(specimens: Specimens, K_b: float, K_e: float) -> str | None:
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
    ask = (
        f"is it in {symbol(unit)}, not {symbol(column.unit)}"
        if column and unit
        else "is the unit right"
    )
    head = column.head if column else "the stiffness"
    return f"{head} is {times(ratio)} the simulated one: {ask}?"
