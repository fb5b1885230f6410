"""A measured file as named columns of checked numbers in our units."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from flexspline.geometry.ranges import SMALLEST_NUMBER
from flexspline.pipeline.diagnosis.measurement.column_names import LABELS
from flexspline.pipeline.diagnosis.measurement.columns import STAMP, ReadColumn, columns_of
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.grid import Grid, read_grid
from flexspline.pipeline.diagnosis.measurement.number_text import (
    Mark,
    evidence_of,
    number_of,
    numbers_of,
)
from flexspline.pipeline.diagnosis.measurement.read_as import ReadAs
from flexspline.pipeline.diagnosis.measurement.time_stamps import (
    counted_seconds,
    form_said,
    form_shown,
    is_day,
    is_short,
    is_slashed,
    seconds_of,
)
from flexspline.pipeline.diagnosis.measurement.workbook import WORKBOOK

LARGEST_NUMBER = 1e12
"""Beyond this no rig reads; a slipped column or exponent does."""
OPTIONAL = ("cycle", "time_s", "temperature_C", "input_angle_deg", "stiffness_std_Nm_per_rad")
"""Columns that may be empty in every row: nothing was recorded then."""
SHOWN = 40
"""Letters of a cell in a message."""


@dataclass(frozen=True)
class MeasuredTable:
    """Columns by our name, e.g. `torque_Nm`; numbers (n,) and labels; `line` (n,) in the file."""

    path: Path
    numbers: Mapping[str, np.ndarray]
    labels: Mapping[str, tuple[str, ...]]
    line: np.ndarray
    read_as: ReadAs

    def __len__(self) -> int:
        return len(self.line)

    def has(self, *names: str) -> bool:
        """Whether all these columns exist."""
        return all(n in self.numbers or n in self.labels for n in names)

    def refuse(self, row: int | None, reason: str) -> MeasurementError:
        """The error for data row `row`, None for the whole file."""
        return MeasurementError(self.path, None if row is None else int(self.line[row]), reason)


def read_table(path: Path, counts_per_turn: float | None = None) -> MeasuredTable:
    """Read a measurement, CSV or .xlsx, as rigs write it (docs/contract.md, section 4).

    Columns whose head names no quantity are kept aside, and so is an optional one that is empty in every
    row; dotted design keys are read as numbers. `counts_per_turn` of the encoder whose column is in counts.

    Raises
    ------
    MeasurementError : anything that cannot be read without guessing.
    """
    return table_of(read_grid(path), counts_per_turn)


def table_of(grid: Grid, counts_per_turn: float | None = None) -> MeasuredTable:
    """The columns of a grid; as `read_table`."""
    columns = columns_of(grid, counts_per_turn)
    if grid.misfit is not None:
        raise grid.misfit
    if not grid.rows:
        raise MeasurementError(grid.path, grid.head_line, "a header and no data rows")
    across = list(zip(*grid.rows, strict=True))
    _refuse_unnamed(grid, across)
    cells = {c.at: [t.strip() for t in across[c.at]] for c in columns}
    empty = [c for c in columns if c.name in OPTIONAL and not any(map(_holds, cells[c.at]))]
    columns = tuple(c for c in columns if c not in empty)
    mark = _decimal_mark(grid, [c for c in columns if _is_number(c)], cells)
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
            numbers[column.name] = _seconds(grid, column, texts)
        else:
            numbers[column.name] = _values(grid, column, texts, mark)
    used = {c.at for c in columns} | {c.day_at for c in columns}
    return MeasuredTable(
        grid.path, numbers, labels, np.array(grid.line),
        ReadAs(
            columns, tuple(h for i, h in enumerate(grid.head) if i not in used and h),
            tuple(c.head for c in empty), grid.encoding, grid.separator_name, mark, grid.head_line,
            bool(grid.unit_row), began, hashlib.sha256(grid.raw).hexdigest(),
        ),
    )  # fmt: skip


def _refuse_unnamed(grid: Grid, across: Sequence[Sequence[str]]) -> None:
    """Refuse values beyond the last name; an unnamed first column is a table's count of its rows."""
    named = max((i for i, head in enumerate(grid.head) if head.strip()), default=-1)
    for cells in across[named + 1 :]:
        for line, text in zip(grid.line, cells, strict=True):
            if _holds(text.strip()):
                reason = (
                    f'"{text.strip()[:SHOWN]}" stands in a column without a name; with decimal commas, '
                    "separate the columns by semicolons"
                )
                raise MeasurementError(grid.path, line, reason)


def _holds(text: str) -> bool:
    return text not in ("", "-") and text.lower() != "nan"


def _is_number(column: ReadColumn) -> bool:
    return column.name not in LABELS and column.unit != STAMP


def _decimal_mark(
    grid: Grid, columns: Sequence[ReadColumn], cells: Mapping[int, list[str]]
) -> Mark:
    """The decimal mark of all the file's numbers.

    Raises
    ------
    MeasurementError : some have a point and some a comma, or all may be read either way.
    """
    seen = [(c, evidence_of(cells[c.at])) for c in columns]
    points = [(c, e.point) for c, e in seen if e.point is not None]
    commas = [(c, e.comma) for c, e in seen if e.comma is not None]
    either = [(c, e.either) for c, e in seen if e.either is not None]

    def said(column: ReadColumn, row: int) -> str:
        return f'{column.head} = "{cells[column.at][row][:SHOWN]}"'

    if points and commas:
        point, comma = min(points, key=lambda p: p[1]), min(commas, key=lambda p: p[1])
        first, later = sorted(((point, "point"), (comma, "comma")), key=lambda p: p[0][1])
        reason = (
            f"{said(*later[0])} has a decimal {later[1]}, {said(*first[0])} in line "
            f"{grid.line[first[0][1]]} a decimal {first[1]}: write all numbers one way"
        )
        raise MeasurementError(grid.path, grid.line[later[0][1]], reason)
    if grid.encoding == WORKBOOK:
        _refuse_text(grid, columns, cells)
    if points or commas:
        mark: Mark = "." if points else ","
        other = "," if points else "."
        proven = {c.at for c, _ in points or commas}
        for column, row in either:
            text = cells[column.at][row]
            if column.at not in proven and other in text:
                whole, part = text.replace(other, ""), text.replace(other, mark)
                reason = (
                    f"{said(column, row)} may be {whole} or {part}, and another column has a decimal "
                    f'"{mark}": write all numbers one way'
                )
                raise MeasurementError(grid.path, grid.line[row], reason)
        return mark
    if either and (grid.separator != "," or "," in cells[either[0][0].at][either[0][1]]):
        column, row = either[0]
        text = cells[column.at][row]
        if grid.encoding != WORKBOOK:
            whole, part = text.replace(",", "").replace(".", ""), text.replace(",", ".")
            reason = f"{said(column, row)} may be {whole} or {part}: write {whole} or {part}0"
            raise MeasurementError(grid.path, grid.line[row], reason)
    return "."


def _refuse_text(grid: Grid, columns: Sequence[ReadColumn], cells: Mapping[int, list[str]]) -> None:
    """Refuse text of a workbook that may be a thousand: a cell that holds a number has no comma."""
    for column in columns:
        for line, text in zip(grid.line, cells[column.at], strict=True):
            if "," in text and number_of(text, ".") is not None:
                whole, part = text.replace(",", ""), text.replace(",", ".")
                reason = (
                    f'{column.head} = "{text[:SHOWN]}" is text, and may be {whole} or {part}: make the '
                    "cell a number"
                )
                raise MeasurementError(grid.path, line, reason)


def _labels(grid: Grid, column: ReadColumn, texts: list[str]) -> tuple[str, ...]:
    empty = next((i for i, t in enumerate(texts) if not t), None)
    if empty is not None:
        raise MeasurementError(grid.path, grid.line[empty], f"{column.head} is empty")
    return tuple(texts)


def _seconds(grid: Grid, column: ReadColumn, texts: list[str]) -> np.ndarray:
    if is_slashed(texts[0]):
        said = f'{column.head} = "{texts[0][:SHOWN]}"'
        reason = f"{said} may begin with the day or the month; write 2024-12-31 12:30:00"
        raise MeasurementError(grid.path, grid.line[0], reason)
    if is_day(texts[0]):
        said = f'{column.head} = "{texts[0][:SHOWN]}"'
        reason = f"{said} is a day without a time of day; write both in one column, or time_s"
        raise MeasurementError(grid.path, grid.line[0], reason)
    found, bad = counted_seconds(texts) if _in_minutes(grid, column, texts) else seconds_of(texts)
    if bad is not None:
        reason = (
            f'{column.head} = "{texts[bad][:SHOWN]}" is no date and time as "{texts[0][:SHOWN]}" is'
        )
        raise MeasurementError(grid.path, grid.line[bad], reason)
    return np.array(found)


def _in_minutes(grid: Grid, column: ReadColumn, texts: list[str]) -> bool:
    """Whether texts of two numbers are minutes and seconds.

    Raises
    ------
    MeasurementError : they may be hours and minutes as well.
    """
    if column.day_at is not None or not is_short(texts[0]):
        return False
    head = f"{column.head} {grid.unit_row[column.at] if grid.unit_row else ''}"
    form = form_said(head) or form_shown(texts)
    if form is None:
        reason = (
            f'{column.head} = "{texts[0]}" may be hours and minutes or minutes and seconds: write '
            f'00:{texts[0]} or {texts[0]}:00, or "mm:ss" or "hh:mm" into the head'
        )
        raise MeasurementError(grid.path, grid.line[0], reason)
    return form == "mm:ss"


def _values(grid: Grid, column: ReadColumn, texts: list[str], mark: Mark) -> np.ndarray:
    """Numbers in our unit; what is nothing, not finite or beyond any rig is refused."""
    values, bad = numbers_of(texts, mark)
    if bad is not None:
        text = texts[bad]
        what = "is empty" if not text else f'= "{text[:SHOWN]}" is not a finite number'
        many = sum(not _holds(t) for t in texts)
        if not _holds(text) and many > 1:
            what += f" (so are {many} of {len(texts)} rows; fill them, or take the column out)"
        raise MeasurementError(grid.path, grid.line[bad], f"{column.head} {what}")
    large = np.flatnonzero(np.abs(values) > LARGEST_NUMBER)
    if len(large):
        found = f"{column.head} = {values[large[0]]:g} is beyond ±{LARGEST_NUMBER:g}"
        raise MeasurementError(grid.path, grid.line[large[0]], found)
    largest = np.abs(values).max()
    if 0 < largest < SMALLEST_NUMBER:
        reason = (
            f"the largest {column.head} is {largest:g}: no rig reads that; is an exponent wrong?"
        )
        raise MeasurementError(grid.path, None, reason)
    values = values * column.factor + column.shift
    return np.where(np.abs(values) < SMALLEST_NUMBER, 0.0, values)
