"""Wrong readings of a sweep: a sensor's fault code, a slipped digit.

One torque of 1e6 N·m is the largest of its record, by which every share of torque is measured, so such rows
go before anything is computed. What a model leaves is looked at later (`outliers.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from flexspline.geometry.ranges import Range
from flexspline.pipeline.diagnosis.measurement.floors import ROUNDING_OF_SUMS
from flexspline.pipeline.diagnosis.measurement.outliers import LONGEST_OUTLIER
from flexspline.pipeline.diagnosis.measurement.runs import runs
from flexspline.pipeline.diagnosis.measurement.table import MeasuredTable
from flexspline.pipeline.diagnosis.measurement.torque_spikes import torque_spikes

FAR_RATIO = 3.0
"""Times as far from the median as every other reading: a programme goes to its largest torque by steps, and a
gear by its slope. Only what stands alone or repeats itself is asked, and only against another channel."""
LEAP_K = 50.0
"""[K] Leap from one row to the next and back. An oven needs minutes for it, a gear hours."""
GEAR_C = Range(-197.0, 400.0)
"""Liquid nitrogen, in which gears for space are tested, boils at −196 °C; above 400 °C no grease and no film
of MoS2 is left. The codes of a broken Pt100 (−200, 850 °C) lie outside."""

Judge = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Of rows far out (n,) and all other rows (n,), masks: which of the first are wrong (n,)."""


@dataclass(frozen=True)
class WrongReadings:
    """Readings of a column, by the file's `head`, and their lines; `values` in the file's own unit."""

    name: str
    head: str
    unit: str
    lines: tuple[int, ...]
    values: tuple[float, ...]

    @property
    def rows_left_out(self) -> int:
        """A row with a wrong temperature stays."""
        return 0 if self.name == "temperature_C" else len(self.lines)


def without_wrong(table: MeasuredTable) -> tuple[MeasuredTable, tuple[WrongReadings, ...]]:
    """The table without rows whose torque or angle is wrong, and all wrong readings.

    Of a wrong temperature the row stays, as friction remembers every torque: its temperature is then on the
    straight line between the readings before and after.
    """
    corrections = []
    for name, wrong_in in (
        ("angle_arcsec", partial(_wrong, name="angle_arcsec", judge_of=_beside_torque)),
        ("torque_Nm", partial(_wrong, name="torque_Nm", judge_of=_beside_angle)),
        ("torque_Nm", _spikes),
    ):
        wrong = wrong_in(table)
        if wrong.any():
            corrections.append(_told(table, name, wrong))
            table = table.rows(~wrong)
    if "temperature_C" in table.numbers:
        wrong = _wrong(table, "temperature_C", _beyond_gears)
        if wrong.any():
            corrections.append(_told(table, "temperature_C", wrong))
            table = _bridged(table, wrong)
    return table, tuple(corrections)


def _wrong(
    table: MeasuredTable, name: str, judge_of: Callable[[MeasuredTable, np.ndarray], Judge]
) -> np.ndarray:
    """(n,) wrong readings of a column; each unit is asked by itself, as its zero is its own."""
    wrong = np.zeros(len(table), bool)
    for rows in table.unit_rows():
        wrong[rows] = _wrong_in_unit(table.numbers[name][rows], judge_of(table, rows))
    return wrong


def _spikes(table: MeasuredTable) -> np.ndarray:
    """(n,) torque readings that did not act on the gear; each unit separately."""
    spike = np.zeros(len(table), bool)
    for rows in table.unit_rows():
        torque, angle = (table.numbers[name][rows] for name in ("torque_Nm", "angle_arcsec"))
        spike[rows] = torque_spikes(torque, angle)
    return spike


def _bridged(table: MeasuredTable, wrong: np.ndarray) -> MeasuredTable:
    """The table with straight lines in time, or in rows without it, over wrong temperatures."""
    celsius = table.numbers["temperature_C"].copy()
    time = table.numbers.get("time_s", np.arange(len(table), dtype=float))
    for rows in table.unit_rows():
        bad, good = rows[wrong[rows]], rows[~wrong[rows]]
        celsius[bad] = np.interp(time[bad], time[good], celsius[good])
    return replace(table, numbers={**table.numbers, "temperature_C": celsius})


def _wrong_in_unit(values: np.ndarray, judge: Judge) -> np.ndarray:
    """(n,) wrong readings, the furthest first: what is left is asked again."""
    kept = np.ones(len(values), bool)
    again = True
    while again:
        again = False
        for far in _far(values, kept):
            wrong = judge(far, kept & ~far)
            if wrong.any():
                kept &= ~wrong
                again = True
                break
    return ~kept


def _far(values: np.ndarray, kept: np.ndarray) -> Iterator[np.ndarray]:
    """Masks (n,) of rows FAR_RATIO times as far from the median as others: fewest first, half at most."""
    rows = np.flatnonzero(kept)
    if not len(rows):
        return
    off = np.abs(values[rows] - np.median(values[rows]))
    order = np.argsort(off)
    out = off[order]
    for i in np.flatnonzero(out[1:] > FAR_RATIO * out[:-1])[::-1] + 1:
        if 2 * i < len(rows):
            return
        far = np.zeros(len(values), bool)
        far[rows[order[i:]]] = True
        yield far


def _alone(far: np.ndarray, values: np.ndarray | None = None) -> np.ndarray:
    """(n,) far rows, one or two in a row, or more whose `values` repeat one number to the last digit."""
    out = np.zeros(len(far), bool)
    for a, b in runs(far):
        repeats = values is not None and np.ptp(values[a:b]) == 0
        out[a:b] = b - a <= LONGEST_OUTLIER or repeats
    return out


def _beside_torque(table: MeasuredTable, rows: np.ndarray) -> Judge:
    return _against_another(table, rows, "angle_arcsec", "torque_Nm")


def _beside_angle(table: MeasuredTable, rows: np.ndarray) -> Judge:
    return _against_another(table, rows, "torque_Nm", "angle_arcsec")


def _against_another(table: MeasuredTable, rows: np.ndarray, name: str, other: str) -> Judge:
    """A reading is wrong where the other channel stays within what it has in all other rows.

    Or where both hold one number, which is the logger's code for a fault.
    """
    values, beside = table.numbers[name][rows], table.numbers[other][rows]
    written, other_written = (_as_written(table, one)[rows] for one in (name, other))
    same = np.isclose(written, other_written, rtol=ROUNDING_OF_SUMS)

    def judge(far: np.ndarray, others: np.ndarray) -> np.ndarray:
        low, high = beside[others].min(), beside[others].max()
        within = (beside >= low) & (beside <= high)
        return _alone(far, values) & (within | same)

    return judge


def _beyond_gears(table: MeasuredTable, rows: np.ndarray) -> Judge:
    """A temperature is wrong where it leaps and comes back, or where no gear is used."""
    celsius = table.numbers["temperature_C"][rows]
    outside = (celsius < GEAR_C.low) | (celsius > GEAR_C.high)

    def judge(far: np.ndarray, others: np.ndarray) -> np.ndarray:
        leaps = np.abs(celsius - np.median(celsius[others])) > LEAP_K
        return far & (outside | (_alone(far) & leaps))

    return judge


def _as_written(table: MeasuredTable, name: str) -> np.ndarray:
    """(n,) in the file's own unit."""
    column = table.read_as.column(name)
    values = table.numbers[name]
    return values if column is None else (values - column.shift) / column.factor


def _told(table: MeasuredTable, name: str, rows: np.ndarray) -> WrongReadings:
    column = table.read_as.column(name)
    head, unit = (name, "") if column is None else (column.head or name, column.unit)
    values = _as_written(table, name)[rows]
    lines = tuple(int(line) for line in table.line[rows])
    return WrongReadings(name, head, unit, lines, tuple(float(v) for v in values))
