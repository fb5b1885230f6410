"""The cells of a measured file: where its head is, how columns are parted, and the rows below."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from flexspline.geometry.input_file import InputFileError, read_input
from flexspline.pipeline.diagnosis.measurement.column_names import column_name
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.failed_reading import SHEET_ERROR
from flexspline.pipeline.diagnosis.measurement.file_text import FileText, texts_of
from flexspline.pipeline.diagnosis.measurement.footer import rows_above_footer
from flexspline.pipeline.diagnosis.measurement.head import Head, LineSplitter, head_of, paired
from flexspline.pipeline.diagnosis.measurement.head_again import heads_again
from flexspline.pipeline.diagnosis.measurement.workbook import BEGIN, WORKBOOK, first_sheet

LARGEST_MEASURED_BYTES = 200_000_000
"""Two million rows of 100 letters; a file beyond this is some other file, or never ends."""
LARGEST_ROWS = 2_000_000
"""Ten readings a second fill them in two days and a half; a fit takes minutes and GB on them."""
SEPARATORS = {",": "comma", ";": "semicolon", "\t": "tab"}
GOES_ON = "a quoted field goes on in the next line; close its quotation mark"
OPEN = "a quotation mark opens here and never closes"
NEVER_ENDS = "unexpected end of data"
"""Python's words for the same, at the end of the file."""
SHEET = "cells of a sheet"


@dataclass(frozen=True)
class CellGrid:
    """Cells of a file, as text.

    Attributes
    ----------
    head : one text for each column; `head_line` where it stands. unit_row : units below it, () for none;
        `unit_line` where they stand, that of the head for none.
    rows : as many texts each as `head`. line : of each row. separator : "" in a workbook.
    misfit : what is wrong with the first row that has more or fewer cells, None for none. footer : lines of
        words below the last row. heads_again : lines that repeat the head, or say the columns' data types.
    """

    path: Path
    raw: bytes
    encoding: str
    separator: str
    head: tuple[str, ...]
    head_line: int
    unit_row: tuple[str, ...]
    unit_line: int
    rows: list[list[str]]
    line: list[int]
    misfit: MeasurementError | None = None
    footer: tuple[int, ...] = ()
    heads_again: tuple[int, ...] = ()

    @property
    def separator_name(self) -> str:
        """In words."""
        return SEPARATORS.get(self.separator, SHEET)


def read_grid(path: Path) -> CellGrid:
    """The cells of a CSV or .xlsx file.

    Lines beginning with # are comments, unless nothing else is a head and the last one of them is. Lines
    above the head, and empty ones, are passed over.

    Raises
    ------
    MeasurementError : no text, no head, rows that do not fit it.
    """
    try:
        raw = read_input(path, LARGEST_MEASURED_BYTES, "a measured file")
    except InputFileError as error:
        raise MeasurementError(path, None, str(error)) from None
    if raw.startswith(BEGIN):
        return _of_sheet(path, raw)
    return _of_text(path, raw)


def _of_sheet(path: Path, raw: bytes) -> CellGrid:
    cells = [(n, r) for n, r in first_sheet(path, raw) if not _is_comment(r[0].strip())]
    rows, numbers = [r for _, r in cells], [n for n, _ in cells]
    _refuse_size(path, rows)

    head = head_of(len(rows), lambda i, _: [c.strip() for c in rows[i]], ("",))
    return _grid(path, raw, WORKBOOK, head, rows[head.at :], numbers[head.at :])


@dataclass(frozen=True)
class _Lines:
    """A text's lines that are neither empty nor comments, where they stand, and which is the head."""

    text: FileText
    head: Head
    lines: list[str]
    numbers: list[int]


def _of_text(path: Path, raw: bytes) -> CellGrid:
    # of equals the first encoding is taken
    read = max((_lines(path, t) for t in texts_of(path, raw)), key=lambda lines: lines.head.score)
    head, numbers = read.head, read.numbers
    _refuse_spaces(path, head, numbers)
    rows = _parsed(path, read.lines[head.at :], numbers[head.at :], head.separator)
    return _grid(path, raw, read.text.encoding, head, rows, numbers[head.at :])


def _lines(path: Path, file_text: FileText) -> _Lines:
    lines: list[str] = []
    numbers: list[int] = []
    comments: list[tuple[int, str]] = []
    for number, row in enumerate(file_text.text.splitlines(), 1):
        bare = row.strip()
        if _is_comment(bare):
            if not lines:
                comments.append((number, bare.lstrip("# \t")))
        elif bare.strip(";,\t "):
            lines.append(row)
            numbers.append(number)
    _refuse_size(path, lines)
    head = head_of(len(lines), _splitter(lines), tuple(SEPARATORS))
    if comments and head.score == 0:
        above = head_of(len(comments), _splitter([c for _, c in comments]), tuple(SEPARATORS))
        if above.score > 0:
            lines.insert(0, comments[above.at][1])
            numbers.insert(0, comments[above.at][0])
            head = Head(0, above.separator, above.cells, [], above.score)
    return _Lines(file_text, head, lines, numbers)


def _is_comment(text: str) -> bool:
    """Whether a line is one; a row may begin with a reading that failed."""
    return text.startswith("#") and SHEET_ERROR.match(text) is None


def _refuse_size(path: Path, rows: Sequence[object]) -> None:
    if not rows:
        raise MeasurementError(
            path, None, "holds no header line; expected columns such as torque_Nm"
        )
    if len(rows) > LARGEST_ROWS:
        raise MeasurementError(path, None, f"{len(rows)} rows; at most {LARGEST_ROWS} are read")


def _refuse_spaces(path: Path, head: Head, numbers: list[int]) -> None:
    names = [column_name(word) for cell in head.cells for word in cell.split()]
    if head.score == 0 and sum(n is not None and n.ours for n in names) > 1:
        reason = "columns must be separated by commas, semicolons or tabs"
        raise MeasurementError(path, numbers[head.at], reason)


def _splitter(lines: list[str]) -> LineSplitter:
    def split(i: int, separator: str) -> list[str]:
        try:
            return [c.strip() for c in next(csv.reader([lines[i]], delimiter=separator))]
        except csv.Error:  # it is said when the rows are read
            return [lines[i]]

    return split


def _parsed(path: Path, lines: list[str], numbers: list[int], separator: str) -> list[list[str]]:
    reader = csv.reader(lines, delimiter=separator, strict=True)
    rows: list[list[str]] = []
    try:
        for row in reader:
            rows.append(row)
            if reader.line_num != len(rows):
                raise MeasurementError(path, numbers[len(rows) - 1], GOES_ON)
    except csv.Error as error:
        at = len(rows)  # until here each row is one line
        reason, goes_on = str(error), reader.line_num > at + 1
        if reason == NEVER_ENDS or (goes_on and not any('"' in t for t in lines[at + 1 :])):
            reason = OPEN
        elif goes_on:
            reason = GOES_ON
        raise MeasurementError(path, numbers[at], reason) from None
    return rows


def _grid(
    path: Path, raw: bytes, encoding: str, head: Head, rows: list[list[str]], numbers: list[int]
) -> CellGrid:
    """The body under the head, each row made as long as it, without what is empty and the remarks below."""
    names = [c.strip() for c in rows[0]]
    first = 2 if head.units else 1
    body, line = rows[first:], numbers[first:]
    width = len(names)
    kept = [i for i, row in enumerate(body) if any(row) and any(c.strip() for c in row)]
    if len(kept) < len(body):
        body, line = [body[i] for i in kept], [line[i] for i in kept]
    again = heads_again(names, head.units, body)
    said = tuple(line[i] for i in again)
    if again:
        kept = sorted(set(range(len(body))) - set(again))
        body, line = [body[i] for i in kept], [line[i] for i in kept]
    last = rows_above_footer(names, body)
    body, line, footer = body[:last], line[:last], tuple(line[last:])
    named = max((i + 1 for i, name in enumerate(names) if name), default=0)
    fewest = named if head.separator else 0
    misfit = None
    for row, number in zip(body, line, strict=True):
        fields = len(row)
        if fields == width:
            continue
        if misfit is None and (fields < fewest or any(c.strip() for c in row[width:])):
            misfit = _misfit(path, number, row, width, head.separator)
        row[:] = (row + [""] * (width - fields))[:width]
    units = tuple(u for _, u in paired(names, head.units)) if head.units else ()
    return CellGrid(
        path, raw, encoding, head.separator, tuple(names), numbers[0], units, numbers[first - 1],
        body, line, misfit, footer, said,
    )  # fmt: skip


def _misfit(path: Path, line: int, row: list[str], wanted: int, separator: str) -> MeasurementError:
    fields = len(row)
    reason = f"{fields} {'field' if fields == 1 else 'fields'} where the header has {wanted}"
    if fields == 1 and any(other in row[0] for other in SEPARATORS if other != separator):
        reason += "; the header's separator stands nowhere in this line"
    if separator == "," and fields in (2 * wanted, 2 * wanted - 1):
        reason += "; with decimal commas, "
        if wanted == 1:  # not read so: "1,20" may be two columns of which one has no name
            reason += "put the numbers in quotation marks or write decimal points"
        else:
            reason += "separate the columns by semicolons"
    return MeasurementError(path, line, reason)
