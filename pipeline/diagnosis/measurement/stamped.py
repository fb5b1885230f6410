"""Dates and times of day of a column as seconds from its first row."""

from __future__ import annotations

import re

import numpy as np

from flexspline.pipeline.diagnosis.measurement.columns import ReadColumn
from flexspline.pipeline.diagnosis.measurement.decimal_mark import CELL_CHARS
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.grid import CellGrid
from flexspline.pipeline.diagnosis.measurement.time_form import (
    ALL,
    MINUTES_SECONDS,
    TimeForm,
    form_said,
)
from flexspline.pipeline.diagnosis.measurement.time_stamps import (
    PART,
    is_clock,
    is_day,
    is_short,
    is_slashed,
    seconds_of,
    short_are_minutes,
)

OUT_OF_RANGE = (
    "is out of range: months go to 12, hours after a date to 23 (midnight is 00:00 of the next day),"
    " minutes and seconds to 59"
)


def seconds_from(grid: CellGrid, column: ReadColumn, texts: list[str]) -> np.ndarray:
    """(n,) seconds.

    Raises
    ------
    MeasurementError : a text that is no stamp, or one that two readings fit.
    """
    if is_slashed(texts[0]):
        said = f'{column.head} = "{texts[0][:CELL_CHARS]}"'
        reason = f"{said} may begin with the day or the month; write 2024-12-31 12:30:00"
        raise MeasurementError(grid.path, grid.line[0], reason)
    if is_day(texts[0]):
        said = f'{column.head} = "{texts[0][:CELL_CHARS]}"'
        reason = f"{said} is a day without a time of day; write both in one column, or time_s"
        raise MeasurementError(grid.path, grid.line[0], reason)
    form = form_said(f"{column.head} {grid.unit_row[column.at] if grid.unit_row else ''}")
    if form is not None:
        _refuse_other_form(grid, column, texts, form)
    in_minutes = is_short(texts[0]) and _in_minutes(grid, column, texts, form)
    seconds, bad = seconds_of(texts, in_minutes)
    if bad is not None:
        other = f'is not a date and time as "{texts[0][:CELL_CHARS]}" is'
        why = OUT_OF_RANGE if _shape(texts[bad]) == _shape(texts[0]) else other
        reason = f'{column.head} = "{texts[bad][:CELL_CHARS]}" {why}'
        raise MeasurementError(grid.path, grid.line[bad], reason)
    return np.array(seconds)


def _shape(text: str) -> str:
    return re.sub(r"\d+", "0", text)


def _refuse_other_form(
    grid: CellGrid, column: ReadColumn, texts: list[str], form: TimeForm
) -> None:
    """Refuse times that are not as the head says they are."""
    first = texts[0]
    short = is_short(first)
    if (short and form.numbers == ALL) or (
        not short and is_clock(first) and form.numbers == MINUTES_SECONDS
    ):
        count = "two" if short else "three"
        reason = (
            f'{column.head} = "{first[:CELL_CHARS]}" has {count} numbers, not {form.numbers} as its'
            f" head says: correct the head, or write {form.numbers}"
        )
        raise MeasurementError(grid.path, grid.line[0], reason)
    if not form.parts_digits:
        return
    for text, line in zip(texts, grid.line, strict=True):
        part = PART.search(text)
        if part is not None and len(part[1]) < form.parts_digits:
            full = form.parts_digits
            reason = (
                f'{column.head} = "{text[:CELL_CHARS]}": its parts of a second may be {part[1]:0>{full}} or'
                f" {part[1]:0<{full}}; write all {full} digits"
            )
            raise MeasurementError(grid.path, line, reason)


def _in_minutes(
    grid: CellGrid, column: ReadColumn, texts: list[str], form: TimeForm | None
) -> bool:
    """Whether texts of two numbers are minutes and seconds.

    Raises
    ------
    MeasurementError : they may be hours and minutes as well.
    """
    if form is not None:
        return form.numbers == MINUTES_SECONDS
    if short_are_minutes(texts):
        return True
    row = next((i for i, t in enumerate(texts) if t.strip("0:")), 0)
    reason = (
        f'{column.head} = "{texts[row]}" may be hours and minutes or minutes and seconds: write '
        f'{texts[row]}:00 or 00:{texts[row]}, or "hh:mm" or "mm:ss" into the head'
    )
    raise MeasurementError(grid.path, grid.line[row], reason)
