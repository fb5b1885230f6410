"""The quantity and the unit of each column of a file."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from flexspline.geometry.full_width import narrow
from flexspline.geometry.listed import joined
from flexspline.geometry.ranges import COUNTS_PER_TURN
from flexspline.pipeline.diagnosis.measurement.column_names import ColumnName, column_name
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.failed_reading import is_failed
from flexspline.pipeline.diagnosis.measurement.grid import CellGrid
from flexspline.pipeline.diagnosis.measurement.head import with_unit
from flexspline.pipeline.diagnosis.measurement.number_text import number_of
from flexspline.pipeline.diagnosis.measurement.time_form import ALL, is_parted
from flexspline.pipeline.diagnosis.measurement.time_stamps import is_clock, is_day, is_stamp
from flexspline.pipeline.diagnosis.measurement.units import (
    ARCSEC_PER_TURN,
    COUNTS,
    KELVIN_AT_0_C,
    QUANTITIES,
)

STAMP = "date and time"
"""Read in the place of a unit."""


@dataclass(frozen=True)
class ReadColumn:
    """A column of the file, `at` its place, as ours: value = factor · number + shift.

    `head` is what the file calls it. `unit` is in our words, "" for labels and counted cycles, `STAMP` for
    dates; `day_at` the place of the day where the column has the time of day only.
    """

    at: int
    head: str
    name: str
    unit: str = ""
    factor: float = 1.0
    shift: float = 0.0
    day_at: int | None = None


def columns_of(grid: CellGrid, counts_per_turn: float | None) -> tuple[ReadColumn, ...]:
    """The columns that are read, each with its unit.

    Of a name that this program writes and one in other words the first is taken. Columns beyond are left.

    Raises
    ------
    MeasurementError : two columns for one quantity, a quantity without its unit or with an unknown one.
    """
    if counts_per_turn is not None and counts_per_turn not in COUNTS_PER_TURN:
        reason = f"--counts-per-turn = {counts_per_turn:g}: must be {COUNTS_PER_TURN}"
        raise MeasurementError(grid.path, None, reason)
    _refuse_numbers(grid)
    _refuse_parted_time(grid)
    chosen = _chosen(grid)
    counted = [grid.head[at] for at, name in chosen if name.unit == COUNTS]
    if counts_per_turn is not None and len(counted) != 1:
        many = f"both {joined(counted, 'and')} are counts" if counted else "no column has counts"
        reason = f"--counts-per-turn is of one column in counts; here {many}"
        raise MeasurementError(grid.path, grid.head_line, reason)
    return tuple(_read(grid, at, name, counts_per_turn) for at, name in chosen)


def _refuse_numbers(grid: CellGrid) -> None:
    if all(number_of(head, ".") is not None for head in grid.head if head):
        reason = (
            "numbers where the header belongs; write the columns' names above them, such as "
            "torque_Nm,angle_arcsec"
        )
        raise MeasurementError(grid.path, grid.head_line, reason)


def _refuse_parted_time(grid: CellGrid) -> None:
    for one, following in pairwise(grid.head):
        if is_parted(one, following):
            reason = (
                f'"{one}" and "{following}" are the parts of one time: write it into one column, as'
                " 00:00:01.250; where its comma parts the columns, separate them by semicolons"
            )
            raise MeasurementError(grid.path, grid.head_line, reason)


def _chosen(grid: CellGrid) -> list[tuple[int, ColumnName]]:
    """Place and meaning of each column that is read."""
    below = grid.unit_row or ("",) * len(grid.head)
    candidates: dict[str, list[tuple[int, ColumnName]]] = {}
    seen: set[str] = set()
    for at, (head, unit) in enumerate(zip(grid.head, below, strict=True)):
        if head and head in seen:
            raise MeasurementError(grid.path, grid.head_line, f"column {head} appears twice")
        seen.add(head)
        name = _with_row(grid, head, unit)
        if name is not None:
            candidates.setdefault(name.quantity, []).append((at, name))
    chosen = [_one(grid, rivals) for rivals in candidates.values()]
    return sorted((c for c in chosen if c is not None), key=lambda pair: pair[0])


def _with_row(grid: CellGrid, head: str, below: str) -> ColumnName | None:
    """What a head and the unit below it say together."""
    name = column_name(head)
    if name is not None and name.unit is None and name.strange is not None:
        return name
    if not below or (name is not None and name.quantity not in QUANTITIES):
        return name
    joined = column_name(with_unit(head, below))
    if name is None or name.unit is None:
        return joined
    if joined is not None and (joined.strange or joined.unit not in (None, name.unit)):
        reason = f'column {head} has "{below}" below it: two units; leave one'
        raise MeasurementError(grid.path, grid.head_line, reason)
    return name


def _one(grid: CellGrid, rivals: list[tuple[int, ColumnName]]) -> tuple[int, ColumnName] | None:
    """Of the columns that may be one quantity the one that is."""
    quantity = rivals[0][1].quantity
    ours = [r for r in rivals if r[1].ours]
    if len(ours) > 1:
        key = _name(quantity)
        reason = f"column {key} appears as {' and as '.join(grid.head[at] for at, _ in ours)}"
        raise MeasurementError(grid.path, grid.head_line, reason)
    if ours:
        return ours[0]
    if quantity == "time":
        rivals = _times(grid, rivals)
    # words beside the quantity's and no unit: a remark as likely as a reading
    meant = [r for r in rivals if r[1].sure or r[1].unit or r[1].strange]
    if not meant:
        return None
    if len(meant) > 1:
        fits = joined((f'"{grid.head[at]}"' for at, _ in meant), "and")
        reason = f"columns {fits} both fit {quantity}; name the one that is meant {_name(quantity)}"
        raise MeasurementError(grid.path, grid.head_line, reason)
    return meant[0]


def _times(grid: CellGrid, rivals: list[tuple[int, ColumnName]]) -> list[tuple[int, ColumnName]]:
    """Numbers with a unit are preferred to stamps of the same moments; a day belongs to its time of day."""
    timed = [r for r in rivals if r[1].unit]
    clocks = [r for r in rivals if not is_day(_first(grid, r[0]))]
    return timed or (clocks if len(clocks) == 1 == len(rivals) - 1 else rivals)


def _first(grid: CellGrid, at: int) -> str:
    texts = (row[at].strip() for row in grid.rows)
    return next((text for text in texts if not is_failed(text)), "")


def _day_beside(grid: CellGrid, at: int) -> int | None:
    """Place of the only column with days, where the one at `at` has times of day."""
    if not is_clock(_first(grid, at)):
        return None
    days = [i for i, head in enumerate(grid.head) if head and is_day(_first(grid, i))]
    return days[0] if len(days) == 1 else None


def _name(quantity: str) -> str:
    return f"{quantity}_{QUANTITIES[quantity].unit}" if quantity in QUANTITIES else quantity


def _read(grid: CellGrid, at: int, name: ColumnName, counts_per_turn: float | None) -> ReadColumn:
    head, quantity = grid.head[at], name.quantity
    if quantity not in QUANTITIES:
        return ReadColumn(at, head, quantity)
    known, ours = QUANTITIES[quantity], _name(quantity)
    if name.unit is None:
        if quantity == "time" and name.strange is None and is_stamp(_first(grid, at)):
            return ReadColumn(at, head, ours, STAMP, day_at=_day_beside(grid, at))
        raise MeasurementError(grid.path, _line_of_unit(grid, at, name), _no_unit(head, name))
    if name.unit == COUNTS:
        if counts_per_turn is None:
            reason = f"column {head} is in counts; say --counts-per-turn N, its counts in a turn"
            raise MeasurementError(grid.path, grid.head_line, reason)
        return ReadColumn(
            at, head, ours, COUNTS,
            ARCSEC_PER_TURN / counts_per_turn * known.factors["arcsec"],
        )  # fmt: skip
    shift = -KELVIN_AT_0_C if name.unit == "K" else 0.0
    return ReadColumn(at, head, ours, name.unit, known.factors[name.unit], shift)


def _line_of_unit(grid: CellGrid, at: int, name: ColumnName) -> int:
    """Where an unknown unit stands: in the row of units where the head alone says none."""
    alone = column_name(grid.head[at])
    in_row = name.strange is not None and (alone is None or alone.strange is None)
    return grid.unit_line if in_row else grid.head_line


def unit_not_known(head: str, wanted: str) -> str | None:
    """Why a column that was left out may be the one wanted, such as angle_arcsec; None where it is not.

    Its head names the quantity, but words stand beside it that are no unit: "Angle (xyz)".
    """
    for text in (_in_square(head), head):
        name = column_name(text)
        if name is not None and name.quantity in QUANTITIES and _name(name.quantity) == wanted:
            return _no_unit(head, name) if name.unit is None else None
    return None


def _in_square(head: str) -> str:
    """With the last round brackets as square ones, in which a unit must stand."""
    before, opens, inside = narrow(head).rpartition("(")
    return f"{before}[{inside.replace(')', ']', 1)}" if opens else head


def _no_unit(head: str, name: ColumnName) -> str:
    ways = [f"{name.quantity}_{u}" for u in QUANTITIES[name.quantity].factors]
    accepted = ", ".join(ways + [ALL] * (name.quantity == "time"))
    if (name.strange or "").lower() == "grad":
        both = f"{name.quantity}_deg or {name.quantity}_gon"
        return f"column {head}: grad may be degrees or gon; write {both}"
    why = f'"{name.strange}" is not a known unit of it' if name.strange else "it has no unit"
    return f"column {head}: accepted are {accepted}; {why}"
