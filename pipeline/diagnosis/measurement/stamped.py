"""Dates and times of day of a column as seconds from its first row."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.columns import ReadColumn
from flexspline.pipeline.diagnosis.measurement.decimal_mark import SHOWN
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.grid import CellGrid
from flexspline.pipeline.diagnosis.measurement.time_stamps import (
    counted_seconds,
    form_said,
    form_shown,
    is_day,
    is_short,
    is_slashed,
    seconds_of,
)


def seconds_from(grid: CellGrid, column: ReadColumn, texts: list[str]) -> np.ndarray:
    """(n,) seconds.

    Raises
    ------
    MeasurementError : a text that is no stamp, or one that two readings fit.
    """
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


def _in_minutes(grid: CellGrid, column: ReadColumn, texts: list[str]) -> bool:
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
        row = next((i for i, t in enumerate(texts) if t.strip("0:")), 0)
        reason = (
            f'{column.head} = "{texts[row]}" may be hours and minutes or minutes and seconds: write '
            f'{texts[row]}:00 or 00:{texts[row]}, or "hh:mm" or "mm:ss" into the head'
        )
        raise MeasurementError(grid.path, grid.line[row], reason)
    return form == "mm:ss"
