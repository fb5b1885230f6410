"""How a measured file was understood, in words and as JSON."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from flexspline.geometry.errors import one_line
from flexspline.geometry.listed import listed
from flexspline.pipeline.diagnosis.measurement.columns import STAMP, ReadColumn
from flexspline.pipeline.diagnosis.measurement.lost_readings import LostReadings
from flexspline.pipeline.diagnosis.measurement.read_as import ReadAs
from flexspline.pipeline.diagnosis.measurement.units import COUNTS, QUANTITIES, symbol
from flexspline.pipeline.diagnosis.measurement.workbook import WORKBOOK
from flexspline.pipeline.diagnosis.measurement.wrong_readings import WrongReadings

MARKS = {".": "point", ",": "comma"}
HEAD_LETTERS = 60
"""Of a column's head in a sentence: the longest of our own names and a unit; a file may hold anything."""


def form_record(read_as: ReadAs) -> dict[str, Any]:
    """Encoding, separator, decimal mark and place of the head."""
    return {
        "encoding": read_as.encoding,
        "separator": read_as.separator,
        "decimal_mark": MARKS[read_as.decimal_mark],
        "header_line": read_as.head_line,
    }


def columns_record(read_as: ReadAs) -> dict[str, Any]:
    """For each column that is read, by its name in the file: ours, its unit, and the factor to ours."""
    return {c.head or c.name: _column(c, read_as) for c in read_as.columns}


def _column(column: ReadColumn, read_as: ReadAs) -> dict[str, Any]:
    record: dict[str, Any] = {"as": column.name}
    if column.unit:
        record["unit"] = column.unit
    if column.unit == STAMP:
        record["counted_from"] = read_as.began
    elif column.unit:
        record["factor"] = column.factor
        if column.shift:
            record["shift"] = column.shift
    return record


def reading_notes(read_as: ReadAs) -> list[str]:
    """What a reader should check, one line each; none where the file is written in our words and units."""
    if read_as.as_ours or not read_as.columns:
        return []
    columns = "; ".join(
        f'"{one_line(c.head, HEAD_LETTERS)}" as {_words(c, read_as)}' for c in read_as.columns
    )
    notes = [f"columns read: {columns}", f"file read as {form_words(read_as)}"]
    if read_as.empty:
        notes.append(f"columns empty in every row: {heads(read_as.empty)}")
    if read_as.heads_again:
        lines = listed(read_as.heads_again, "lines")
        notes.append(f"skipped, repeated header or data types: line {lines}")
    if read_as.footer:
        lines = listed(read_as.footer, "lines")
        notes.append(f"skipped, text below the last row: line {lines}")
    return notes


def wrong_notes(readings: Iterable[WrongReadings]) -> list[str]:
    """Readings taken as wrong: column, numbers and lines in the file."""
    return [_wrong_words(wrong) for wrong in readings]


def lost_note(lost: LostReadings) -> str:
    """Rows in which nothing was recorded: how many, and where."""
    count = len(lost.lines)
    s = "s" * (count > 1)
    where = f"line{s} {listed(lost.lines, 'lines')}"
    return (
        f"{heads(lost.heads)} {'have' if len(lost.heads) > 1 else 'has'} no reading in {count} of "
        f"{lost.rows} rows ({where}): left out; the other rows stay in order, at their times"
    )


def _wrong_words(wrong: WrongReadings) -> str:
    s = "s" * (len(wrong.lines) > 1)
    numbers = listed((f"{v:.9g}" for v in dict.fromkeys(wrong.values)), "numbers")
    where = f"line{s} {listed(wrong.lines, 'lines')}"
    what = f"{heads([wrong.head])} = {numbers} {symbol(wrong.unit)}".rstrip()
    after = (
        f"the row{s} {'are' if s else 'is'} left out"
        if wrong.rows_left_out
        else "it is replaced by a straight line between the readings before and after"
    )
    return f"{what} in {where}, far from all other readings, is taken as a fault of the sensor: {after}"


def heads(names: Iterable[str]) -> str:
    """Heads of columns as they may be printed: on one line, without control characters."""
    return ", ".join(one_line(name, HEAD_LETTERS) for name in names)


def form_words(read_as: ReadAs) -> str:
    """Encoding, separator, decimal mark and head in one line."""
    if read_as.encoding == WORKBOOK:
        return f"the workbook's first sheet, header in row {read_as.head_line}"
    units = ", units below it" if read_as.unit_row else ""
    return (
        f"{read_as.encoding}, columns separated by {read_as.separator}, decimal "
        f"{MARKS[read_as.decimal_mark]}, header in line {read_as.head_line}{units}"
    )


def _words(column: ReadColumn, read_as: ReadAs) -> str:
    if column.unit == STAMP:
        return f"{column.name}, counted from {read_as.began}"
    quantity = next(
        (q for q in sorted(QUANTITIES, key=len, reverse=True) if column.name.startswith(q)), ""
    )
    if not quantity or not column.unit or (column.factor == 1 and not column.shift):
        return column.name
    if column.unit == COUNTS:
        return f"{column.name}, {column.factor:.6g} each"
    unit, ours = symbol(column.unit), symbol(QUANTITIES[quantity].unit)
    if column.shift:
        return f"{column.name}, in {unit} ({column.shift:g} added)"
    return f"{column.name}, in {unit} (1 {unit} = {column.factor:.6g} {ours})"
