"""The first sheet of an .xlsx workbook as rows of text, by the standard library alone.

A workbook is a zip of XML files (ECMA-376, part 1, chapter 18). Of it are read: which sheet is first, the
strings that cells share, which number formats are dates, and the values of the cells as they were last
computed. Formulas, styles and other sheets are not looked at.
"""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path
from xml.etree import ElementTree

from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError

DAMAGE = (
    zipfile.BadZipFile, zlib.error, ElementTree.ParseError, LookupError, ValueError, OverflowError,
    StopIteration, EOFError, OSError, NotImplementedError, RuntimeError,
)  # fmt: skip
"""Errors of a damaged zip, damaged XML, or XML of another kind of file."""
WORKBOOK = "xlsx"
"""What a workbook has in the place of a text's encoding."""
BEGIN = b"PK\x03\x04"
"""How a zip begins."""
LARGEST_PART = 1_000_000_000
"""Bytes of one unpacked file: a full sheet, 1 048 576 rows of six numbers, has 300 million."""
EPOCH, EPOCH_1904 = datetime(1899, 12, 30), datetime(1904, 1, 1)
"""Day 0 of Excel's serial numbers from March 1900 on (18.17.4.1), and of workbooks with date1904."""
DATE_FORMATS = frozenset((*range(14, 23), *range(45, 48)))
"""Built-in number formats of dates and times (18.8.30)."""
DATE_LETTERS = re.compile(r"[dmyhs]", re.IGNORECASE)
QUOTED = re.compile(r'"[^"]*"|\\.|\[[^\]]*\]')
"""What a number format shows as it stands, and colours; letters there make no date."""
COLUMN = re.compile(r"[A-Z]+")
RELATION = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"
RELATION_STRICT = "{http://purl.oclc.org/ooxml/officeDocument/relationships}id"
MOST_COLUMNS = 16_384
"""Excel's own limit, column XFD."""


def first_sheet(path: Path, raw: bytes) -> list[tuple[int, list[str]]]:
    """Row number and texts of each row of the first sheet that has any cell.

    Numbers are given as Python writes them, dates as ISO 8601.

    Raises
    ------
    MeasurementError : no workbook, a damaged one, or one too large.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(raw)) as book:
            return _rows(path, book)
    except MeasurementError:
        raise
    except DAMAGE as error:
        reason = f"is not a readable .xlsx workbook ({str(error) or type(error).__name__})"
        raise MeasurementError(path, None, reason) from None


def _rows(path: Path, book: zipfile.ZipFile) -> list[tuple[int, list[str]]]:
    names = set(book.namelist())
    if "xl/workbook.xml" not in names:
        kind = "an OpenDocument file" if "mimetype" in names else "a zip without a workbook"
        raise MeasurementError(path, None, f"is {kind}; save it as .xlsx or as CSV")
    top = ElementTree.fromstring(_part(path, book, "xl/workbook.xml"))
    sheet = next(e for e in top.iter() if _tag(e) == "sheet")
    wanted = sheet.get(RELATION) or sheet.get(RELATION_STRICT)
    links = ElementTree.fromstring(_part(path, book, "xl/_rels/workbook.xml.rels"))
    target = next(e.get("Target", "") for e in links if e.get("Id") == wanted)
    part = target.lstrip("/") if target.startswith("/") else f"xl/{target}"
    shared = _shared(path, book) if "xl/sharedStrings.xml" in names else []
    dates = _dates(path, book) if "xl/styles.xml" in names else frozenset()
    old = any(_tag(e) == "workbookPr" and e.get("date1904") in ("1", "true") for e in top.iter())
    cells = _CellTexts(shared, dates, EPOCH_1904 if old else EPOCH)
    return list(cells.rows(io.BytesIO(_part(path, book, part))))


class _CellTexts:
    """Texts of cells, by the workbook's shared strings, date styles and day 0."""

    def __init__(self, shared: list[str], dates: frozenset[int], epoch: datetime) -> None:
        self.shared, self.dates, self.epoch = shared, dates, epoch

    def rows(self, sheet: io.BytesIO) -> Iterator[tuple[int, list[str]]]:
        number = 0
        for _, element in ElementTree.iterparse(sheet):
            if _tag(element) != "row":
                continue
            number = int(element.get("r", number + 1))
            texts: list[str] = []
            for cell in element:
                at = _column(cell.get("r", ""), len(texts))
                texts += [""] * (at - len(texts))
                texts.append(self.text(cell))
            if any(texts):
                yield number, texts
            element.clear()

    def text(self, cell: ElementTree.Element) -> str:
        kind = cell.get("t", "n")
        if kind == "inlineStr":
            return "".join(e.text or "" for e in cell.iter() if _tag(e) == "t")
        value = next((e.text or "" for e in cell if _tag(e) == "v"), "")
        if kind == "s":
            return self.shared[int(value)]
        if kind == "n" and value and int(cell.get("s", 0)) in self.dates:
            return self.stamp(float(value))
        return value

    def stamp(self, days: float) -> str:
        """ISO 8601 of a serial number; below 1 it is a time of day."""
        moment = self.epoch + timedelta(microseconds=round(days * 86_400e6))
        return moment.time().isoformat() if 0 <= days < 1 else moment.isoformat(" ")


def _column(reference: str, following: int) -> int:
    """0 for A; where a cell has no reference it follows the one before."""
    letters = COLUMN.match(reference)
    if letters is None:
        return following
    at = 0
    for letter in letters[0]:
        at = 26 * at + ord(letter) - ord("A") + 1
    if not following < at <= MOST_COLUMNS:
        raise ValueError(f"cell {reference} is out of place")
    return at - 1


def _shared(path: Path, book: zipfile.ZipFile) -> list[str]:
    top = ElementTree.fromstring(_part(path, book, "xl/sharedStrings.xml"))
    return [
        "".join(
            t.text or "" for part in item if _tag(part) in ("t", "r") for t in part.iter() if _tag(t) == "t"
        )
        for item in top
        if _tag(item) == "si"
    ]  # fmt: skip


def _dates(path: Path, book: zipfile.ZipFile) -> frozenset[int]:
    """Indices of cell styles that show a date or a time."""
    top = ElementTree.fromstring(_part(path, book, "xl/styles.xml"))
    own = {
        int(e.get("numFmtId", 0)): DATE_LETTERS.search(QUOTED.sub("", e.get("formatCode", "")))
        for e in top.iter()
        if _tag(e) == "numFmt"
    }
    styles = next((e for e in top if _tag(e) == "cellXfs"), ())
    ids = [int(s.get("numFmtId", 0)) for s in styles]
    return frozenset(i for i, n in enumerate(ids) if own.get(n, n in DATE_FORMATS))


def _part(path: Path, book: zipfile.ZipFile, name: str) -> bytes:
    if book.getinfo(name).file_size > LARGEST_PART:
        reason = f"{name} in it has more than {LARGEST_PART} bytes; save the sheet as CSV"
        raise MeasurementError(path, None, reason)
    return book.read(name)


def _tag(element: ElementTree.Element) -> str:
    """Name without its namespace: strict and transitional workbooks have different ones."""
    return element.tag.rpartition("}")[2]
