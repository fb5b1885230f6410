"""Names in any script: printed, or replaced and said; a page and the attached file keep them."""

import pytest
from hand_made_gear import content, design
from page_text import letters, pdf_letters, read_page
from pypdf import PdfReader
from written_report import write_report

from flexspline.results.report.missing_letters import font_folder, printable
from flexspline.results.report.page import page_of
from flexspline.results.report.sections import run_document

CHINESE = "谐波减速器 柔轮"
PRINTED = {
    "Arabic": "كأس مرن", "Hebrew": "גביע", "Greek": "Κύπελλο", "Cyrillic": "Стакан",
    "Polish": "Główny zespół", "signs": "⌀ 40 → λ/2 ″ ± Ω",
}  # fmt: skip


@pytest.fixture
def bare(monkeypatch):
    """A computer without fonts of its own."""
    import typst

    monkeypatch.setattr(typst, "Fonts", lambda **_: type("None", (), {"fonts": lambda _: []})())


def empty_boxes(path):
    """Letters that the PDF draws with glyph 0 of some font: the box for what a font lacks."""
    found = 0
    for page in PdfReader(path).pages:
        for operands, operator in page.get_contents().operations:
            if operator == b"Tj":
                shown = bytes(operands[0].original_bytes)
                found += sum(shown[i : i + 2] == b"\0\0" for i in range(0, len(shown), 2))
    return found


def test_letters_without_a_font_are_replaced_and_said(tmp_path, bare):
    made = content(design=design(name=CHINESE))
    write_report(tmp_path / "r.pdf", made)
    text = pdf_letters(tmp_path / "r.pdf")
    assert empty_boxes(tmp_path / "r.pdf") == 0
    assert "".join(f"[U+{ord(c):04X}]" for c in CHINESE.split()[-1]) in text
    assert letters("7 different letters in names or notes cannot be printed") in text
    assert not set(CHINESE.replace(" ", "")) & set(text)
    assert CHINESE in PdfReader(tmp_path / "r.pdf").metadata.title
    shown, _, _ = read_page(page_of(run_document(made), {}).decode())
    assert letters(CHINESE) in shown
    assert "cannot be printed" not in shown


@pytest.mark.parametrize("script", PRINTED)
def test_other_scripts_are_printed(tmp_path, bare, script):
    value, count = printable({"name": PRINTED[script]})
    assert (value["name"], count) == (PRINTED[script], 0)
    write_report(tmp_path / "r.pdf", content(design=design(name=PRINTED[script])))
    assert empty_boxes(tmp_path / "r.pdf") == 0
    assert "cannot be printed" not in " ".join(
        p.extract_text() for p in PdfReader(tmp_path / "r.pdf").pages
    )


def test_a_font_of_the_system_serves():
    """As if the computer had a font with these letters."""
    fonts = [frozenset(map(ord, "abc")), frozenset(map(ord, CHINESE))]
    assert printable([CHINESE], lambda: fonts) == ([CHINESE], 0)


def test_a_report_in_latin_letters_reads_no_font():
    def refuse():
        raise AssertionError("fonts were read")

    assert printable(["Größe 40 – 5 µm", "j′ ≥"[:2]], refuse)[1] == 0


def test_the_fonts_are_there():
    assert (font_folder() / "DejaVuSans.ttf").is_file()


def test_a_long_word_is_copied_as_it_is(tmp_path):
    """It may break at the end of a line, after its points and underscores; nothing invisible is added."""
    key = "wave_generator." + "a_long_part_of_a_key_" * 5 + "youngs_modulus_GPa"
    write_report(tmp_path / "r.pdf", content(design=design(name=key)))
    said = "".join(page.extract_text() for page in PdfReader(tmp_path / "r.pdf").pages)
    assert "\u200b" not in said
    assert key in said.replace("\n", "")
