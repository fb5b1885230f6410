"""A report holds what one needs to compute it again: every dimension, masses, date, the file itself."""

import base64
import hashlib
import re
from dataclasses import replace

import pytest
from example_files import EXAMPLES
from hand_made_gear import content, design
from page_text import letters, pdf_letters, read_page
from pypdf import PdfReader
from written_report import write_report

from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design
from flexspline.results.report.attached import Attachment
from flexspline.results.report.dimensions import ratio
from flexspline.results.report.issued import issued
from flexspline.results.report.page import page_of
from flexspline.results.report.sections import run_document

NASTY = (
    "../../etc/passwd", 'a"b<c>&d.toml', "#read(1).toml", "名前.toml", ".hidden", "a\nb.toml", "x" * 300,
)  # fmt: skip


def both(made, folder):
    """Letters of the PDF and of the page."""
    write_report(folder / "r.pdf", made)
    shown, _, _ = read_page(page_of(run_document(made), {}).decode())
    return pdf_letters(folder / "r.pdf"), shown


@pytest.mark.parametrize("name", ["xb1-40", "hat-25", "keyed-shaft"])
def test_every_number_of_the_design_file_is_in_the_report(tmp_path, name):
    """Read from the file's text, not from the program's reading of it."""
    path = EXAMPLES / f"{name}.toml"
    lines = [s.partition("#")[0] for s in path.read_text().splitlines()]
    found = [re.match(r"(\w+)_(mm|um|GPa|MPa|pct|deg|Nm) = ([\d.]+)", s) for s in lines]
    asked = [(m[1].replace("_", ""), f"{float(m[3]):g}") for m in found if m]
    asked = [(key.replace("youngs", "Young's"), number) for key, number in asked]
    assert len(asked) > 25
    for text in both(content(design=load_design(path)), tmp_path):
        for key, number in asked:
            assert key + number in text, (key, number)


def test_twenty_segments_are_all_there(tmp_path):
    tables = design().model_dump(exclude_none=True)
    tables["shaft"]["segment"] = [
        {"length_mm": 2.0 + i / 100, "outer_diameter_mm": 30.0 - i / 2} for i in range(20)
    ]
    made = content(design=Design.model_validate(tables))
    for text in both(made, tmp_path):
        for i in range(20):
            assert letters(f"segment[{i}]length {2.0 + i / 100:g} mm") in text


def test_ratio_and_masses(tmp_path):
    """A tube of steel in closed form: the shaft of the hand-made gear is a plain bar."""
    bar = 3.141592653589793 / 4 * 17.0**2 * 24.0 * 7.85e-3
    assert ratio(design()) == "100 : 1"  # 200/(202 - 200)
    for text in both(content(), tmp_path):
        assert letters("ratio 100 : 1") in text
        assert letters(f"shaft {bar:.2f} g") in text


def test_the_date_is_that_of_the_environment(monkeypatch, tmp_path):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "951782400")  # 2000-02-29
    assert issued("1.0").endswith("· 2000-02-29")
    for text in both(content(), tmp_path):
        assert "20000229" in text  # hyphens are layout to `letters`
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "tomorrow")
    assert re.fullmatch(r"flexspline 1\.0 · \d{4}-\d\d-\d\d", issued("1.0"))


def test_the_file_is_attached_byte_for_byte(tmp_path):
    data = b"\xef\xbb\xbf" + "name = 'Größe'\r\n# 中 <b> </pre> {{x}}\t\n".encode()
    made = content(attached=(Attachment("a b.toml", data, "Design file"),))
    write_report(tmp_path / "r.pdf", made)
    assert PdfReader(tmp_path / "r.pdf").attachments["a b.toml"] == [data]
    html = page_of(run_document(made), {}).decode()
    shown, tags, attributes = read_page(html)
    (link,) = (v for t, n, v in attributes if (t, n) == ("a", "href") and v.startswith("data:"))
    assert base64.b64decode(link.partition(",")[2]) == data
    assert ("a", "download", "a b.toml") in attributes
    assert letters(data.decode("utf-8-sig")) in shown
    assert "b" not in tags[tags.index("pre") :]
    for text in (shown, pdf_letters(tmp_path / "r.pdf")):
        assert hashlib.sha256(data).hexdigest() in text


@pytest.mark.parametrize("name", NASTY)
def test_a_file_s_name_is_data(tmp_path, name):
    made = content(attached=(Attachment(name, b"x = 1\n", "Design file"),))
    write_report(tmp_path / "r.pdf", made)
    attachments = PdfReader(tmp_path / "r.pdf").attachments
    assert {data for n in attachments for data in attachments[n]} == {b"x = 1\n"}
    assert not any(set(n) & set('/\\<>"\n') for n in attachments)
    page_of(run_document(made), {})


def test_two_files_are_both_attached(tmp_path):
    files = (Attachment("s.toml", b"s", "Study file"), Attachment("d.toml", b"d", "Design file"))
    write_report(tmp_path / "r.pdf", replace(content(), attached=files))
    found = PdfReader(tmp_path / "r.pdf").attachments
    assert {n: found[n] for n in found} == {"s.toml": [b"s"], "d.toml": [b"d"]}
