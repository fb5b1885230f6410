"""The three kinds of measurement, told apart by their columns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from flexspline.geometry.part_name import PartName
from flexspline.geometry.ranges import SMALLEST_ANGLE_arcsec, STIFFNESS_Nm_per_rad, TORQUE_Nm
from flexspline.pipeline.diagnosis.measurement.encoder_step import encoder_step
from flexspline.pipeline.diagnosis.measurement.held_angle import held_rows
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.history_reading import history_of
from flexspline.pipeline.diagnosis.measurement.lost_readings import LostReadings
from flexspline.pipeline.diagnosis.measurement.missing_columns import columns_missing
from flexspline.pipeline.diagnosis.measurement.read_as import AS_OURS, ReadAs
from flexspline.pipeline.diagnosis.measurement.table import MeasuredTable, read_table
from flexspline.pipeline.diagnosis.measurement.units import ARCSEC_PER_TURN
from flexspline.pipeline.diagnosis.measurement.wrong_readings import WrongReadings, without_wrong

FEWEST_SWEEP_ROWS = 4
"""Fewest rows, and fewest different torques: one more than zero, stiffness and gap."""
LARGEST_TURN_PER_ROW = 0.01
"""Share of a turn from one row to the next: 3.6°, far beyond the twist of any locked gear and its noise."""


@dataclass(frozen=True)
class Averaging:
    """How a long record was made shorter: rows in the file, rows that went into means, and how these scatter.

    within : sums over the rows averaged of da², da·dT and dT², the distances of angle [arcsec] and torque
        [N·m] from their means.
    encoder_step_arcsec : of the readings, 0 where there is none: means have none.
    """

    rows_read: int
    rows_averaged: int
    within: tuple[float, float, float]
    encoder_step_arcsec: float

    def variance_within(self, compliance: float) -> float:
        """[arcsec²] of a row's angle about its mean's, torque as read taken off; arcsec per N·m."""
        angle, both, torque = self.within
        summed = angle - 2 * compliance * both + compliance**2 * torque
        return max(summed, 0.0) / self.rows_averaged


@dataclass(frozen=True)
class Sweep:
    """Torque sweeps with the wave generator locked: `angle_arcsec` (n,) for each row of `history`."""

    path: Path
    history: History
    angle_arcsec: np.ndarray
    units: tuple[str, ...]
    cycles: tuple[tuple[float, ...], ...]
    """The file's own cycle numbers of each unit."""
    line: np.ndarray
    cycles_recorded: bool
    read_as: ReadAs = AS_OURS
    averaging: Averaging | None = None
    """None where the rows are those of the file."""
    wrong: tuple[WrongReadings, ...] = ()
    """Readings whose rows were left out."""
    held_rows: int = 0
    """Rows left out, as a slow channel's angle repeats the one before."""
    lost: LostReadings | None = None
    """Rows left out, in which torque or angle was not recorded."""
    went_to: np.ndarray | None = None
    """Of each data row of the file, the row here that it is or went into, −1 where it was left out; None
    where the rows are those of the file."""

    def __len__(self) -> int:
        return len(self.angle_arcsec)

    @cached_property
    def encoder_step_arcsec(self) -> float:
        """Of the file's readings; 0 where there is none."""
        if self.averaging is not None:
            return self.averaging.encoder_step_arcsec
        return encoder_step(self.angle_arcsec)

    @property
    def own_cycle(self) -> np.ndarray:
        """(n,) cycle as the file numbers it."""
        first = np.array([numbers[0] for numbers in self.cycles])
        return np.asarray(self.history.cycle + first[self.history.unit])

    def file_rows(self, chosen: np.ndarray) -> np.ndarray:
        """Data rows of the file, from 0, that are the chosen rows (mask) or went into them."""
        if self.went_to is None:
            return np.flatnonzero(chosen)
        return np.flatnonzero((self.went_to >= 0) & chosen[self.went_to])


@dataclass(frozen=True)
class EndPoints:
    """Angles at +T and −T of several units; arrays (n,)."""

    path: Path
    unit: tuple[str, ...]
    torque_Nm: np.ndarray
    angle_plus_arcsec: np.ndarray
    angle_minus_arcsec: np.ndarray
    read_as: ReadAs = AS_OURS

    @property
    def total_arcsec(self) -> np.ndarray:
        """(n,) from −T to +T."""
        return self.angle_plus_arcsec - self.angle_minus_arcsec

    def rows(self, chosen: np.ndarray) -> EndPoints:
        """The chosen rows (indices)."""
        return replace(
            self,
            unit=tuple(self.unit[i] for i in chosen),
            torque_Nm=self.torque_Nm[chosen],
            angle_plus_arcsec=self.angle_plus_arcsec[chosen],
            angle_minus_arcsec=self.angle_minus_arcsec[chosen],
        )


@dataclass(frozen=True)
class Specimens:
    """Measured stiffness of several parts; `overrides` design keys with a value for each row."""

    path: Path
    specimen: tuple[str, ...]
    part: tuple[str, ...]
    stiffness_Nm_per_rad: np.ndarray
    stiffness_std_Nm_per_rad: np.ndarray | None
    overrides: dict[str, np.ndarray]
    line: np.ndarray
    part_recorded: bool = True
    read_as: ReadAs = AS_OURS


Measurement = Sweep | EndPoints | Specimens


def read_measurement(path: Path, counts_per_turn: float | None = None) -> Measurement:
    """Read a CSV file or workbook of any of the three kinds of docs/contract.md.

    `counts_per_turn` of the encoder, where a column is in counts.

    Raises
    ------
    MeasurementError : unreadable, no known kind, or values that cannot be.
    """
    table = read_table(path, counts_per_turn, leave_out=True)
    if table.has("stiffness_Nm_per_rad") and _names(table, "specimen", "unit"):
        return _specimens(table)
    if table.has("angle_plus_arcsec", "angle_minus_arcsec"):
        return _end_points(table)
    if table.has("torque_Nm", "angle_arcsec"):
        return _sweep(table)
    wanted = {
        "a torque sweep": ("torque_Nm", "angle_arcsec"),
        "end points": ("unit", "torque_Nm", "angle_plus_arcsec", "angle_minus_arcsec"),
        "specimens": ("specimen", "stiffness_Nm_per_rad"),
    }
    kind, missing = min(
        ((k, [n for n in names if not table.has(n)]) for k, names in wanted.items()),
        key=lambda pair: len(pair[1]) / len(wanted[pair[0]]),
    )
    raise columns_missing(table, missing, kind)


def _names(table: MeasuredTable, *columns: str) -> tuple[str, ...] | None:
    """Names or numbers of what was measured, by the first of these columns that there is."""
    return next((table.labels[c] for c in columns if c in table.labels), None)


def _sweep(as_read: MeasuredTable) -> Sweep:
    table, wrong = without_wrong(as_read)
    held = held_rows(table)
    table, n = table.rows(~held), int((~held).sum())
    if n < FEWEST_SWEEP_ROWS:
        raise table.refuse(
            n - 1, f"{n} data rows; a torque sweep needs at least {FEWEST_SWEEP_ROWS}"
        )
    if np.any(table.numbers["torque_Nm"]):  # none at all is too little data, and no error
        _refuse_empty(table, "torque_Nm", TORQUE_Nm.low)
    _refuse_empty(table, "angle_arcsec", SMALLEST_ANGLE_arcsec)
    reading = history_of(table)
    _refuse_full_turns(table, reading.history.unit)
    history, went_to = reading.history, _went_to(as_read, table)
    if went_to is not None and history.time_s is None:  # rows are counted as the file has them
        history = replace(history, number=np.flatnonzero(went_to >= 0).astype(float))
    return Sweep(
        table.path, history, table.numbers["angle_arcsec"], reading.units, reading.cycles,
        table.line, "cycle" in table.numbers, table.read_as, wrong=wrong,
        held_rows=int(held.sum()), went_to=went_to, lost=as_read.lost,
    )  # fmt: skip


def _went_to(as_read: MeasuredTable, left: MeasuredTable) -> np.ndarray | None:
    """The row that is `left` of each row read, −1 of none; None where all are left. A line is a row."""
    lost = () if as_read.lost is None else as_read.lost.lines
    if len(left) == len(as_read) and not lost:
        return None
    stays = np.isin(np.sort([*as_read.line, *lost]), left.line)
    return np.where(stays, np.cumsum(stays) - 1, -1)


def _refuse_empty(table: MeasuredTable, name: str, least: float) -> None:
    """Refuse readings that are all zero: a channel that was not connected, or a slipped exponent."""
    largest = np.abs(table.numbers[name]).max()
    if largest < least:
        unit = name.rpartition("_")[2].replace("Nm", "N·m")
        raise table.refuse(
            None,
            f"the largest {name} is {largest:g}: a measurement needs at least {least:g} {unit}; "
            "is the unit right, was the channel connected?",
        )


def _refuse_full_turns(table: MeasuredTable, unit: np.ndarray) -> None:
    """Refuse an encoder that passed its full turn; not unwrapped here, for a drop-out to 0 looks the same."""
    step = np.where(np.diff(unit) == 0, np.diff(table.numbers["angle_arcsec"]), 0.0)
    turns = np.round(step / ARCSEC_PER_TURN)
    jumps = np.flatnonzero(np.abs(turns) == 1)
    rest = np.abs(step - turns * ARCSEC_PER_TURN)
    if not len(jumps) or np.any(rest > LARGEST_TURN_PER_ROW * ARCSEC_PER_TURN):
        return
    column = table.read_as.column("angle_arcsec")
    more = f", the first of {len(jumps)} times" if len(jumps) > 1 else ""
    raise table.refuse(
        int(jumps[0]) + 1,
        f"{column.head if column else 'the angle'} jumps by 360° here{more}: did the encoder pass a full "
        "turn? Unwrap it: from each jump on add 360°, or take 360° off",
    )


def _end_points(table: MeasuredTable) -> EndPoints:
    units = _names(table, "unit", "specimen")
    missing = [*([] if units else ["unit"]), *([] if table.has("torque_Nm") else ["torque_Nm"])]
    if units is None or missing:
        raise columns_missing(table, missing, "end points")
    torque = table.numbers["torque_Nm"]
    bad = np.flatnonzero(~((torque >= TORQUE_Nm.low) & (torque <= TORQUE_Nm.high)))
    if len(bad):
        reason = f"torque_Nm = {torque[bad[0]]:g}: must be {TORQUE_Nm} N·m; both signs are meant"
        raise table.refuse(int(bad[0]), reason)
    angles = np.abs([table.numbers[f"angle_{way}_arcsec"] for way in ("plus", "minus")])
    if angles.max() < SMALLEST_ANGLE_arcsec:
        _refuse_empty(table, "angle_plus_arcsec", SMALLEST_ANGLE_arcsec)
    return EndPoints(
        table.path, units, torque,
        table.numbers["angle_plus_arcsec"], table.numbers["angle_minus_arcsec"], table.read_as,
    )  # fmt: skip


PARTS_IN_ROW: Mapping[str, tuple[PartName, ...]] = {
    "flexspline": ("flexspline",),
    "shaft": ("shaft",),
    "series": ("flexspline", "shaft"),
}
"""Parts of a specimen, by what its column `part` says."""


def _specimens(table: MeasuredTable) -> Specimens:
    n = len(table)
    part = table.labels.get("part", ("series",) * n)
    for i, p in enumerate(part):
        if p not in PARTS_IN_ROW:
            raise table.refuse(i, f'part = "{p[:40]}": must be one of {", ".join(PARTS_IN_ROW)}')
    for name in ("stiffness_Nm_per_rad", "stiffness_std_Nm_per_rad"):
        values = table.numbers.get(name, np.ones(n))
        low, high = STIFFNESS_Nm_per_rad
        bad = np.flatnonzero(~((values >= low) & (values <= high)))
        if len(bad):
            reason = f"{name} = {values[bad[0]]:g}: must be {STIFFNESS_Nm_per_rad} N·m/rad"
            raise table.refuse(int(bad[0]), reason)
    return Specimens(
        table.path, _names(table, "specimen", "unit") or (), part,
        table.numbers["stiffness_Nm_per_rad"], table.numbers.get("stiffness_std_Nm_per_rad"),
        {k: v for k, v in table.numbers.items() if "." in k}, table.line,
        "part" in table.labels, table.read_as,
    )  # fmt: skip
