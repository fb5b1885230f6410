"""The first sheet of a workbook: as another program wrote it, and parts as the standard allows them."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import Sweep, read_measurement

BY_OPENPYXL = Path(__file__).with_name("by_openpyxl.xlsx")
"""Written by openpyxl 3.1: two lines above the head, dates, gaps in a column of remarks, a second sheet."""
TORQUE = [0, 0.25, 0.5, 0.25, 0, -0.25, -0.5, -0.25] * 2
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
LINK = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
SHEETS = '<sheets><sheet name="a" sheetId="1" r:id="x7"/></sheets>'
BOOK = f'<workbook xmlns="{MAIN}" xmlns:r="{LINK}">{SHEETS}</workbook>'
LINKS = '<Relationships><Relationship Id="x7" Target="/xl/worksheets/odd.xml"/></Relationships>'


def workbook(path: Path, rows: str, **more: str) -> Path:
    sheet = f'<worksheet xmlns="{MAIN}"><sheetData>{rows}</sheetData></worksheet>'
    with zipfile.ZipFile(path, "w") as book:
        book.writestr("xl/workbook.xml", BOOK)
        book.writestr("xl/_rels/workbook.xml.rels", LINKS)
        book.writestr("xl/worksheets/odd.xml", sheet)
        for name, text in more.items():
            book.writestr(f"xl/{name}.xml", text)
    return path


def sweep(path: Path) -> Sweep:
    found = read_measurement(path)
    assert isinstance(found, Sweep)
    return found


def test_a_sheet_of_another_program() -> None:
    found = sweep(BY_OPENPYXL)
    assert found.history.torque_Nm == pytest.approx(TORQUE)
    side = [(t > 0) - (t < 0) for t in TORQUE]
    angle = [11.25 * t + 36 * s for t, s in zip(TORQUE, side, strict=True)]
    assert found.angle_arcsec == pytest.approx(angle)
    # a day as a double: 45 000 days to 2⁻³⁷ of one, 0.6 µs
    assert found.history.time_s == pytest.approx([0.5 * i for i in range(16)], abs=2e-6)
    assert found.history.cycle.tolist() == [0] * 8 + [1] * 8
    assert found.read_as.ignored == ("Bemerkung",)
    assert (found.read_as.encoding, found.read_as.head_line) == ("xlsx", 3)


def test_shared_and_inline_strings_and_cells_left_out(tmp_path: Path) -> None:
    rich = "<si><r><t>Angle </t></r><r><t>[deg]</t></r></si>"
    shared = f'<sst xmlns="{MAIN}"><si><t>Torque </t></si>{rich}</sst>'
    first = '<c r="B4" t="inlineStr"><is><t>Torque [Nm]</t></is></c>'
    head = f'<row r="4">{first}<c r="D4" t="s"><v>1</v></c></row>'
    body = "".join(
        f'<row r="{5 + i}"><c r="B{5 + i}"><v>{t}</v></c><c r="D{5 + i}"><f>B1</f><v>{t / 100}</v></c></row>'
        for i, t in enumerate(TORQUE)
    )
    found = sweep(workbook(tmp_path / "a.xlsx", head + body, sharedStrings=shared))
    assert found.history.torque_Nm.tolist() == TORQUE
    assert found.angle_arcsec == pytest.approx([36 * t for t in TORQUE])
    assert found.line.tolist() == list(range(5, 21))


def test_days_since_1904(tmp_path: Path) -> None:
    """Day 0 of such workbooks is 1 January 1904; format 22 is a date with its time."""
    book = BOOK.replace("<sheets>", '<workbookPr date1904="1"/><sheets>')
    formats = '<cellXfs><xf numFmtId="0"/><xf numFmtId="22"/></cellXfs>'
    styles = f'<styleSheet xmlns="{MAIN}">{formats}</styleSheet>'
    head = "".join(
        f'<c t="inlineStr"><is><t>{h}</t></is></c>' for h in ("Time", "torque_Nm", "angle_arcsec")
    )
    body = "".join(
        f'<row><c s="1"><v>{1 + i / 86400}</v></c><c><v>{i}</v></c><c><v>9</v></c></row>'
        for i in range(6)
    )
    path = workbook(tmp_path / "a.xlsx", f"<row>{head}</row>{body}", styles=styles)
    with zipfile.ZipFile(path) as old:
        parts = {name: old.read(name) for name in old.namelist()}
    parts["xl/workbook.xml"] = book.encode()
    with zipfile.ZipFile(path, "w") as new:
        for name, data in parts.items():
            new.writestr(name, data)
    found = sweep(path)
    assert found.read_as.began == "1904-01-02 00:00:00"
    assert found.history.time_s == pytest.approx(range(6), abs=2e-6)


DAMAGED = {
    "cut short": "<row><c><v>1</v>",
    "a string that is not there": '<row><c t="s"><v>7</v></c></row>',
    "a column beyond the last": '<row><c r="ZZZZ1"><v>1</v></c></row>',
    "cells out of order": '<row><c r="B1"><v>1</v></c><c r="A1"><v>1</v></c></row>',
    "entities": "<row>&a;</row>",
}


@pytest.mark.parametrize("name", DAMAGED)
def test_damaged_workbooks_are_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(MeasurementError, match=r"a\.xlsx: is not a readable \.xlsx workbook"):
        read_measurement(workbook(tmp_path / "a.xlsx", DAMAGED[name]))


def test_any_damage_is_refused_or_read(tmp_path: Path) -> None:
    """Bytes changed and cut out at random: nothing but a refusal in one line comes out."""
    rng, whole, path = np.random.default_rng(11), BY_OPENPYXL.read_bytes(), tmp_path / "a.xlsx"
    refusals: list[str] = []
    for _ in range(300):
        data = bytearray(whole)
        for at in rng.integers(4, len(data) - 50, 3):
            data[at] = rng.integers(256)
            del data[at + 1 : at + 1 + rng.integers(0, 3)]
        path.write_bytes(bytes(data))
        try:
            read_measurement(path)
        except MeasurementError as refusal:
            refusals.append(str(refusal))
    assert len(refusals) > 150
    assert not any("\n" in said for said in refusals)


def test_a_zip_of_something_else(tmp_path: Path) -> None:
    path = tmp_path / "a.ods"
    with zipfile.ZipFile(path, "w") as book:
        book.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
    with pytest.raises(MeasurementError, match="OpenDocument"):
        read_measurement(path)


def test_an_empty_sheet(tmp_path: Path) -> None:
    with pytest.raises(MeasurementError, match="no header line"):
        read_measurement(workbook(tmp_path / "a.xlsx", ""))


def test_text_that_may_be_a_thousand_is_refused(tmp_path: Path) -> None:
    heads = ("torque_Nm", "angle_arcsec")
    head = "".join(f'<c t="inlineStr"><is><t>{name}</t></is></c>' for name in heads)
    text = '<c t="inlineStr"><is><t>1,250</t></is></c>'
    body = "".join(f"<row><c><v>{t}</v></c>{text}</row>" for t in TORQUE)
    path = workbook(tmp_path / "a.xlsx", f"<row>{head}</row>{body}")
    with pytest.raises(MeasurementError, match=r'"1,250" is text, and may be 1250 or 1\.250'):
        sweep(path)
