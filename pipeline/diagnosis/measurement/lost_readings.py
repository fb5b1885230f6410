"""Rows of a sweep in which a reading that is used failed, or was not recorded: a logger that lost samples.

They are left out and the rows around them stay in their order, at their own times: a lag, a drift and a lost
row's place are then those of the file. Friction remembers the torques at which it turned. A hole that is
short beside a cycle hides of such a torque what lies between two rows, as any step of a programme does; a
longer one may hide the turn itself, so it is refused.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexspline.geometry.listed import joined
from flexspline.geometry.percent import percent
from flexspline.pipeline.diagnosis.measurement.columns import ReadColumn
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.failed_reading import is_failed
from flexspline.pipeline.diagnosis.measurement.grid import CellGrid
from flexspline.pipeline.diagnosis.measurement.runs import runs

MOST_LOST = 0.05
"""Of a file's rows; of more it is not known why, and whether at random."""
LONGEST_HOLE, HOLE_SHARE = 3, 0.01
"""Lost rows one after another, or this share of all rows where that is more: of a record of four cycles a
twenty-fifth of one."""
MEASURED = ("torque_Nm", "angle_arcsec")
"""The columns of a sweep, without one of which a row says nothing."""
OPTIONAL = ("cycle", "time_s", "temperature_C", "input_angle_deg", "stiffness_std_Nm_per_rad")
"""Columns that may be empty in every row: nothing was recorded then."""


@dataclass(frozen=True)
class LostReadings:
    """Rows left out: their lines, the file's rows, and the columns, by its heads, without a reading there."""

    lines: tuple[int, ...]
    rows: int
    heads: tuple[str, ...]


def without_lost(
    grid: CellGrid, columns: tuple[ReadColumn, ...]
) -> tuple[CellGrid, LostReadings | None]:
    """The grid without rows that lost a reading, and these rows; as it is where it is no sweep, or none.

    Raises
    ------
    MeasurementError : too many of them, of all rows or one after another.
    """
    if len([c for c in columns if c.name in MEASURED]) < len(MEASURED):
        return grid, None
    used = [c for c in columns if c.name in (*MEASURED, *OPTIONAL)]
    empty = {c.head: _failed(grid, c) for c in used}
    optional = [c.head for c in used if c.name in OPTIONAL]
    empty = {head: here for head, here in empty.items() if head not in optional or not here.all()}
    lost = np.logical_or.reduce(list(empty.values()))
    if not lost.any():
        return grid, None
    counts = {head: int(here.sum()) for head, here in empty.items() if here.any()}
    spared = [head for head in counts if head in optional]
    way = f", or take {joined(spared, 'or')} out" if spared else ""
    if lost.sum() > MOST_LOST * len(lost):
        columns_said = joined((f"{head} in {count}" for head, count in counts.items()), "and")
        reason = (
            f"{lost.sum()} of {len(lost)} rows lack a reading ({columns_said}); up to {percent(MOST_LOST)} "
            f"of the rows are left out by themselves: fill them, or leave these rows out{way}"
        )
        raise MeasurementError(grid.path, grid.line[int(lost.argmax())], reason)
    first, end = max(runs(lost), key=lambda run: run[1] - run[0])
    longest = max(LONGEST_HOLE, int(HOLE_SHARE * len(lost)))
    if end - first > longest:
        reason = (
            f"{joined(counts, 'or')} has no reading in {end - first} rows one after another; at most "
            f"{longest} are left out, as a longer hole may hide a reversal of the torque: fill them{way}"
        )
        raise MeasurementError(grid.path, grid.line[first], reason)
    kept = np.flatnonzero(~lost)
    lines = tuple(grid.line[i] for i in np.flatnonzero(lost))
    rest = replace(grid, rows=[grid.rows[i] for i in kept], line=[grid.line[i] for i in kept])
    return rest, LostReadings(lines, len(lost), tuple(counts))


def _failed(grid: CellGrid, column: ReadColumn) -> np.ndarray:
    """(n,) rows in which the column, or the day beside its time of day, has no reading."""
    places = [at for at in (column.at, column.day_at) if at is not None]
    return np.array([any(is_failed(row[at].strip()) for at in places) for row in grid.rows])
