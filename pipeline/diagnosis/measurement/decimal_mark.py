"""Whether a file's numbers have a decimal point or a comma."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from flexspline.pipeline.diagnosis.measurement.columns import ReadColumn
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.grid import CellGrid
from flexspline.pipeline.diagnosis.measurement.number_text import (
    DecimalMark,
    evidence_of,
    number_of,
)
from flexspline.pipeline.diagnosis.measurement.workbook import WORKBOOK

CELL_CHARS = 40
"""Most characters of a cell in a message."""


def decimal_mark(
    grid: CellGrid, columns: Sequence[ReadColumn], cells: Mapping[int, list[str]]
) -> DecimalMark:
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
        return f'{column.head} = "{cells[column.at][row][:CELL_CHARS]}"'

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
        mark: DecimalMark = "." if points else ","
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


def _refuse_text(
    grid: CellGrid, columns: Sequence[ReadColumn], cells: Mapping[int, list[str]]
) -> None:
    """Refuse text of a workbook that may be a thousand: a cell that holds a number has no comma."""
    for column in columns:
        for line, text in zip(grid.line, cells[column.at], strict=True):
            if "," in text and number_of(text, ".") is not None:
                whole, part = text.replace(",", ""), text.replace(",", ".")
                reason = (
                    f'{column.head} = "{text[:CELL_CHARS]}" is text, and may be {whole} or {part}: make the '
                    "cell a number"
                )
                raise MeasurementError(grid.path, line, reason)
