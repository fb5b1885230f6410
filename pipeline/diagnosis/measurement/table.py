"""A measured file as named columns of checked numbers in our units."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from flexspline.geometry.errors import DesignFileError
from flexspline.geometry.load import read_toml
from flexspline.geometry.ranges import SMALLEST_NUMBER, TEMPERATURE_C, Range
from flexspline.pipeline.diagnosis.measurement.column_names import LABELS
from flexspline.pipeline.diagnosis.measurement.columns import STAMP, ReadColumn, columns_of
from flexspline.pipeline.diagnosis.measurement.decimal_mark import CELL_CHARS, decimal_mark
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.failed_reading import is_failed
from flexspline.pipeline.diagnosis.measurement.grid import CellGrid, read_grid
from flexspline.pipeline.diagnosis.measurement.lost_readings import (
    OPTIONAL,
    LostReadings,
    without_lost,
)
from flexspline.pipeline.diagnosis.measurement.number_text import DecimalMark, numbers_of
from flexspline.pipeline.diagnosis.measurement.read_as import ReadAs
from flexspline.pipeline.diagnosis.measurement.stamped import seconds_from
from flexspline.pipeline.diagnosis.measurement.units import symbol
from flexspline.pipeline.diagnosis.measurement.workbook import WORKBOOK

LARGEST_NUMBER = 1e12
"""Largest number of a column in our unit. Only a slipped column or exponent is larger."""
LIMITS = {"temperature_C": TEMPERATURE_C}
"""Limits of columns in our unit, where physics sets narrower ones."""


@dataclass(frozen=True)
class MeasuredTable:
    """Columns by our name, e.g. `torque_Nm`; numbers (n,) and labels; `line` (n,) in the file."""

    path: Path
    numbers: Mapping[str, np.ndarray]
    labels: Mapping[str, tuple[str, ...]]
    line: np.ndarray
    read_as: ReadAs
    lost: LostReadings | None = None
    """Rows left out, in which nothing was recorded."""

    def __len__(self) -> int:
        return len(self.line)

    def has(self, *names: str) -> bool:
        """Whether all these columns exist."""
        return all(n in self.numbers or n in self.labels for n in names)

    def unit_rows(self) -> list[np.ndarray]:
        """Row indices of each unit under test."""
        names = np.array(self.labels.get("unit", ("",) * len(self)))
        return [np.flatnonzero(names == name) for name in np.unique(names)]

    def rows(self, chosen: np.ndarray) -> MeasuredTable:
        """The chosen rows (mask)."""
        return replace(
            self,
            numbers={name: values[chosen] for name, values in self.numbers.items()},
            labels={
                name: tuple(text for text, here in zip(texts, chosen, strict=True) if here)
                for name, texts in self.labels.items()
            },
            line=self.line[chosen],
        )

    def refuse(self, row: int | None, reason: str) -> MeasurementError:
        """The error for data row `row`, None for the whole file."""
        return MeasurementError(self.path, None if row is None else int(self.line[row]), reason)


def read_table(
    path: Path, counts_per_turn: float | None = None, leave_out: bool = False
) -> MeasuredTable:
    """Read a measurement, CSV or .xlsx, as rigs write it (docs/contract.md, section 4).

    Columns whose head names no quantity are kept aside, and so is an optional one that is empty in every
    row; dotted design keys are read as numbers. `counts_per_turn` of the encoder whose column is in counts.
    `leave_out`: a sweep's rows that lost a reading, where they are few (`lost_readings`).

    Raises
    ------
    MeasurementError : anything that cannot be read without guessing.
    """
    try:
        table = table_of(read_grid(path), counts_per_turn, leave_out)
    except MeasurementError as fault:
        raise _toml_instead(path) or fault from None
    if not table.read_as.columns and (other := _toml_instead(path)) is not None:
        raise other
    return table


def _toml_instead(path: Path) -> MeasurementError | None:
    """The refusal of a design or another TOML file that was given in place of a record; None of others."""
    try:
        tables = read_toml(path)
    except DesignFileError:  # empty, or no TOML, which a record is not
        return None
    what = "a design file" if "flexspline" in tables else "a TOML file"
    return MeasurementError(path, None, f"is {what}; a measured record (CSV or .xlsx) is expected")


def table_of(
    grid: CellGrid, counts_per_turn: float | None = None, leave_out: bool = False
) -> MeasuredTable:
    """The columns of a grid; as `read_table`."""
    columns = columns_of(grid, counts_per_turn)
    if grid.misfit is not None:
        raise grid.misfit
    if not grid.rows:
        misnamed = grid.path.suffix.lower() == ".xlsx" and grid.encoding != WORKBOOK
        reason = "not a workbook in spite of its name, and as text a" if misnamed else "a"
        raise MeasurementError(grid.path, grid.head_line, f"{reason} header and no data rows")
    grid, lost = without_lost(grid, columns) if leave_out else (grid, None)
    across = list(zip(*grid.rows, strict=True))
    _refuse_unnamed(grid, across)
    cells = {c.at: [t.strip() for t in across[c.at]] for c in columns}
    empty = [c for c in columns if c.name in OPTIONAL and not any(map(_holds, cells[c.at]))]
    columns = tuple(c for c in columns if c not in empty)
    mark = decimal_mark(grid, [c for c in columns if _is_number(c)], cells)
    numbers: dict[str, np.ndarray] = {}
    labels: dict[str, tuple[str, ...]] = {}
    began = ""
    for column in columns:
        texts = cells[column.at]
        if column.name in LABELS:
            labels[column.name] = _labels(grid, column, texts)
        elif column.unit == STAMP:
            if column.day_at is not None:
                texts = [
                    f"{d.strip()} {t}" for d, t in zip(across[column.day_at], texts, strict=True)
                ]
            began = texts[0]
            numbers[column.name] = seconds_from(grid, column, texts)
        else:
            numbers[column.name] = _values(grid, column, texts, mark)
    used = {c.at for c in columns} | {c.day_at for c in columns}
    return MeasuredTable(
        grid.path, numbers, labels, np.array(grid.line),
        ReadAs(
            columns, tuple(h for i, h in enumerate(grid.head) if i not in used and h),
            tuple(c.head for c in empty), grid.encoding, grid.separator_name, mark, grid.head_line,
            bool(grid.unit_row), began, hashlib.sha256(grid.raw).hexdigest(), grid.footer,
            grid.heads_again, tuple(grid.head),
        ),
        lost,
    )  # fmt: skip


def _refuse_unnamed(grid: CellGrid, across: Sequence[Sequence[str]]) -> None:
    """Refuse values beyond the last name; an unnamed first column is a table's count of its rows."""
    named = max((i for i, head in enumerate(grid.head) if head.strip()), default=-1)
    for cells in across[named + 1 :]:
        for line, text in zip(grid.line, cells, strict=True):
            if _holds(text.strip()):
                reason = (
                    f'"{text.strip()[:CELL_CHARS]}" stands in a column without a name; with decimal commas, '
                    "separate the columns by semicolons"
                )
                raise MeasurementError(grid.path, line, reason)


def _holds(text: str) -> bool:
    return not is_failed(text)


def _is_number(column: ReadColumn) -> bool:
    return column.name not in LABELS and column.unit != STAMP


def _labels(grid: CellGrid, column: ReadColumn, texts: list[str]) -> tuple[str, ...]:
    empty = next((i for i, t in enumerate(texts) if not t), None)
    if empty is not None:
        raise MeasurementError(grid.path, grid.line[empty], f"{column.head} is empty: fill it")
    return tuple(texts)


def _values(grid: CellGrid, column: ReadColumn, texts: list[str], mark: DecimalMark) -> np.ndarray:
    """Numbers in our unit; empty cells and numbers that are not finite or beyond any rig are refused."""
    values, bad = numbers_of(texts, mark)
    if bad is not None:
        text = texts[bad]
        what = "is empty" if not text else f'= "{text[:CELL_CHARS]}" is not a finite number'
        many = sum(not _holds(t) for t in texts)
        if not _holds(text):
            rows, them = ("these rows", "them") if many > 1 else ("the row", "it")
            way = "take the column" if column.name in OPTIONAL else f"leave {rows}"
            so = f"so are {many} of {len(texts)} rows; " if many > 1 else ""
            what += f" ({so}fill {them}, or {way} out)"
        raise MeasurementError(grid.path, grid.line[bad], f"{column.head} {what}")
    _refuse_outside(grid, column, values)
    largest = np.abs(values).max()
    if 0 < largest < SMALLEST_NUMBER:
        reason = (
            f"the largest {column.head} is {largest:g}: no rig reads that; is an exponent wrong?"
        )
        raise MeasurementError(grid.path, None, reason)
    values = values * column.factor + column.shift
    return np.where(np.abs(values) < SMALLEST_NUMBER, 0.0, values)


def _refuse_outside(grid: CellGrid, column: ReadColumn, values: np.ndarray) -> None:
    """Refuse values that no rig reads; the limits are ours, put into the file's unit."""
    limits = LIMITS.get(column.name, Range(-LARGEST_NUMBER, LARGEST_NUMBER))
    low, high = ((end - column.shift) / column.factor for end in limits)
    outside = np.flatnonzero((values < low) | (values > high))
    if not len(outside):
        return
    unit = symbol(column.unit)
    if column.name in LIMITS:
        what = f": must be {Range(low, high)} {unit}; leave such rows or the column out"
    else:
        what = f" is beyond ±{high:g} {unit}".rstrip()
    many = f" (the first of {len(outside)} such rows)" if len(outside) > 1 else ""
    reason = f"{column.head} = {values[outside[0]]:.9g}{many}{what}"
    raise MeasurementError(grid.path, grid.line[outside[0]], reason)
