"""Rows of a sweep in which the torque or the angle was not recorded: a logger that lost samples.

They are left out and the rows around them stay in their order, at their own times: a lag, a drift and a lost
row's place are then those of the file. Friction remembers the torques at which it turned. A hole that is
short beside a cycle hides of such a torque what lies between two rows, as any step of a programme does; a
longer one may hide the turn itself, so it is refused.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexspline.geometry.percent import percent
from flexspline.pipeline.diagnosis.measurement.columns import ReadColumn
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.grid import CellGrid
from flexspline.pipeline.diagnosis.measurement.runs import runs

MOST_LOST = 0.05
"""Of a file's rows; of more it is not known why, and whether at random."""
LONGEST_HOLE, HOLE_SHARE = 3, 0.01
"""Lost rows one after another, or this share of all rows where that is more: of a record of four cycles a
twenty-fifth of one."""
MEASURED = ("torque_Nm", "angle_arcsec")
"""The columns of a sweep, without one of which a row says nothing."""


@dataclass(frozen=True)
class LostReadings:
    """Rows left out: their lines, the file's rows, and the columns, by its heads, that are empty there."""

    lines: tuple[int, ...]
    rows: int
    heads: tuple[str, ...]


def is_empty(text: str) -> bool:
    """Whether a cell says that nothing was recorded."""
    return text in ("", "-") or text.lower() == "nan"


def without_lost(
    grid: CellGrid, columns: tuple[ReadColumn, ...]
) -> tuple[CellGrid, LostReadings | None]:
    """The grid without rows that lost a reading, and these rows; as it is where it is no sweep, or none.

    More than MOST_LOST stay in it: their first is refused with the other cells.

    Raises
    ------
    MeasurementError : too many of them one after another.
    """
    measured = [c for c in columns if c.name in MEASURED]
    if len(measured) < len(MEASURED):
        return grid, None
    empty = {c.head: np.array([is_empty(r[c.at].strip()) for r in grid.rows]) for c in measured}
    lost = np.logical_or.reduce(list(empty.values()))
    if not 0 < lost.sum() <= MOST_LOST * len(lost):
        return grid, None
    first, end = max(runs(lost), key=lambda run: run[1] - run[0])
    longest = max(LONGEST_HOLE, int(HOLE_SHARE * len(lost)))
    heads = tuple(head for head, here in empty.items() if here.any())
    if end - first > longest:
        reason = (
            f"{' or '.join(heads)} is empty in {end - first} rows one after another; at most {longest} are "
            "left out, as a longer hole may hide a reversal of the torque: fill them"
        )
        raise MeasurementError(grid.path, grid.line[first], reason)
    kept = np.flatnonzero(~lost)
    lines = tuple(grid.line[i] for i in np.flatnonzero(lost))
    rest = replace(grid, rows=[grid.rows[i] for i in kept], line=[grid.line[i] for i in kept])
    return rest, LostReadings(lines, len(lost), heads)


def too_many(count: int, rows: int) -> str:
    """What is said of so many empty rows of a sweep."""
    if count <= MOST_LOST * rows:
        return ""
    return f"; up to {percent(MOST_LOST)} of the rows are left out by themselves"
