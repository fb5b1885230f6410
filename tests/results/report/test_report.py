"""The PDF: its numbers, its length, and that names are data."""

import re
from dataclasses import replace

import pytest
from blank_pictures import blank_pictures
from hand_made_gear import BACKLASH, K_B, K_E, content, design
from PIL import Image
from pypdf import PdfReader
from written_report import write_report

from flexspline.fea.types import Shortfall
from flexspline.pipeline.stiffnesses import Stiffnesses
from flexspline.results.numbers import THIN
from flexspline.results.quantities import quantity
from flexspline.results.report.budget import budget
from flexspline.results.report.document import (
    Break,
    Document,
    Formula,
    Heading,
    Paragraph,
    Picture,
    Pictures,
    Table,
)
from flexspline.results.report.pdf import ReportError, pdf_of
from flexspline.results.report.sections import run_document
from flexspline.results.report.spans import plain, symbol, worded
from flexspline.results.report.spans import words as spans_of
from flexspline.results.report.tables import answers
from flexspline.results.report.totals import totals_and_terms

NASTY = [
    '#read("/etc/passwd")',
    "*bold* _it_ $x^2$ `raw`",
    '"); #panic("x") //',
    "\\u{41} <label> @ref ~ -- ' ] [ } {",
    "#import \"@preview/x:1.0.0\"",
]  # fmt: skip


def text_of(path):
    # the page's own line breaks and the invisible break points in long words are no content
    pages = [page.extract_text() for page in PdfReader(path).pages]
    return re.sub(r"\s+", " ", " ".join(pages).replace("\u200b", "")), len(pages)


def test_report_says_the_numbers(tmp_path):
    write_report(
        tmp_path / "r.pdf", content(pictures=blank_pictures(tmp_path, 1600, 1200, "any name of "))
    )
    text, pages = text_of(tmp_path / "r.pdf")
    assert 3 <= pages <= 8
    for number in ("84.6", "12.9", "31 655", "31 607 to 31 703", "24 310", "35 290", "16 687",
                   "451", "3.22", "5.8", "6.5", "32.9", "39.3", "24.12"):  # fmt: skip
        assert number.replace(" ", THIN) in text or number in text, number
    for words in ("uniform", "lobes", "N·m/rad", "Hand-made cup", "estimate, not a guarantee",
                  "These bounds are proven", "Page 1 of", "90 % of the stated fatigue limit",
                  "the seat's edges", "numpy 2.0.0", "density 7850 kg/m³ (of steel, not stated)",
                  "mesh of the flexspline 5.3 s", "do not add up"):  # fmt: skip
        assert words in text, words
    assert len(PdfReader(tmp_path / "r.pdf").pages[0].extract_text()) > 1000


def test_report_without_pictures_and_rim_loads(tmp_path):
    bare = content(
        stiffnesses=Stiffnesses({"K_b": K_B, "K_e": K_E}), flexspline_peak=None, wave_generator_peak=None,
        versions=None, stage_seconds=None,
    )  # fmt: skip
    write_report(tmp_path / "r.pdf", bare)
    text, pages = text_of(tmp_path / "r.pdf")
    assert 3 <= pages <= 8
    assert "two lobes" not in text
    assert "fatigue limit of" not in text
    assert "None" not in text


def test_longest_report_stays_within_nine_pages(tmp_path):
    warnings = tuple(f"warning {i} " + "with many words " * 10 for i in range(20))
    write_report(
        tmp_path / "r.pdf",
        content(
            design=design(name="N" * 200, material="M" * 200),
            warnings=warnings,
            pictures=blank_pictures(tmp_path, 1600, 1200, "any name of "),
            stage_seconds={f"a stage with a long name, number {i}": 1.0 for i in range(25)},
        ),
    )
    text, pages = text_of(tmp_path / "r.pdf")
    assert 3 <= pages <= 9
    assert "Read the 20 warnings" in text
    assert "warning 19" in text
    assert "N" * 200 in text.replace(" ", "")


@pytest.mark.parametrize(
    "name", [" ".join(NASTY), *(pytest.param(n, marks=pytest.mark.long) for n in NASTY)]
)
def test_names_print_as_their_letters(tmp_path, name):
    write_report(
        tmp_path / "r.pdf",
        content(design=design(name=name, material=name), warnings=(name,)),
    )
    text, _ = text_of(tmp_path / "r.pdf")
    # page header, title, material, warning: letters only, as typesetting may move spaces
    assert text.replace(" ", "").count(name.replace(" ", "")) >= 4
    assert "root:" not in text


def test_same_content_gives_the_same_bytes(tmp_path):
    for name in ("a.pdf", "b.pdf"):
        write_report(
            tmp_path / name, content(pictures=blank_pictures(tmp_path, 1600, 1200, "any name of "))
        )
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()


def test_series_bounds_use_the_k_b_of_the_sum():
    _, series, *_ = answers(content())
    ends = 1 / (1 / 31607.0 + 1 / 35263.0), 1 / (1 / 31703.0 + 1 / 35317.0)
    assert series["bounds"] == quantity("K_series_Nm_per_rad").range_text(*ends)


@pytest.mark.parametrize(("case", "K_b"), [("uniform", "K_b"), ("lobes", "K_b,lobes")])
def test_the_sum_names_the_k_b_of_its_load_case(case, K_b):
    """In the totals, beside the series stiffness, in the formula as drawn and spoken, in the terms."""
    solver = design().solver.model_copy(update={"load_case": case})
    shown = content(design=design().model_copy(update={"solver": solver}))
    formula, *_ = (b for b in budget(shown, roomy=True) if isinstance(b, Formula))
    terms, *_ = (b for b in budget(shown, roomy=True) if isinstance(b, Table))
    _, series, *_ = answers(shown)
    for said in (totals_and_terms(shown), series["note"], formula.nodes, terms.rows):
        assert set(re.findall(r"K_b[,a-z]*", str(said))) == {K_b}
    assert f"2 T_L / {K_b} + " in formula.spoken


@pytest.mark.parametrize(
    ("models", "flexspline"),
    [
        (("solid", "solid"), None),
        pytest.param(
            ("axisymmetric", "axisymmetric"),
            "K_b, K_b,lobes come from a mesh of the meridian; this mesh is for the stress pictures.",
            marks=pytest.mark.long,
        ),
        (("axisymmetric", "solid"), "K_b comes from a mesh of the meridian; this mesh is for the stress "
                                    "pictures and the other stiffnesses."),
    ],
)  # fmt: skip
def test_a_mesh_that_gave_no_stiffness_says_what_it_is_for(tmp_path, models, flexspline):
    """Bodies of revolution are solved on the meridian; the figure has tetrahedra."""
    K_b, K_lobes = (replace(K_B, model=model) for model in models)
    shown = content(
        stiffnesses=Stiffnesses({"K_b": K_b, "K_b_lobes": K_lobes, "K_e": K_E}),
        pictures=blank_pictures(tmp_path, 1600, 1200, ""),
    )
    captions = {
        p.name: "".join(span.text for span in spans_of(p.caption))
        for block in run_document(shown).blocks if isinstance(block, Pictures)
        for p in block.figures
    }  # fmt: skip
    plain_mesh = "Mesh of the flexspline and its named surfaces."
    finer = "The stress picture is of this mesh; it may be finer than that of the stiffness."
    assert captions["flexspline_mesh"] == f"{plain_mesh} {flexspline or finer}"
    assert captions["shaft_mesh"].startswith(
        "Mesh of the output shaft and its named surfaces. K_e comes"
    )


def test_failure_leaves_the_old_report(tmp_path):
    (tmp_path / "r.pdf").write_bytes(b"old")
    broken = tmp_path / "broken.png"
    broken.write_bytes(b"no picture")
    with pytest.raises(ReportError, match="image"):
        write_report(tmp_path / "r.pdf", content(pictures={"backlash_budget": broken}))
    assert (tmp_path / "r.pdf").read_bytes() == b"old"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["broken.png", "r.pdf"]


def test_budget_shares_are_of_the_total(tmp_path):
    write_report(tmp_path / "r.pdf", content())
    text, _ = text_of(tmp_path / "r.pdf")
    assert f"{100 * BACKLASH.bearing_play_arcsec / BACKLASH.total_arcsec:.0f} %" in text


def test_a_picture_too_high_for_the_page_is_drawn_smaller(tmp_path):
    """Five panels below each other: the caption stays above the page's foot."""
    high = tmp_path / "high.png"
    Image.new("RGB", (1200, 2175), (200, 210, 220)).save(high)
    document = Document(
        "t", "r", "n", "v", (Pictures((Picture("high", "The words below it. " * 12, 86),)),)
    )
    (tmp_path / "r.pdf").write_bytes(pdf_of(document, {"high": high}))
    pages = PdfReader(tmp_path / "r.pdf").pages
    heights = {}

    def seen(text, page, line, *_):
        if text.strip():
            y = line[4] * page[1] + line[5] * page[3] + page[5]
            heights.setdefault(text.strip()[:8], []).append(y)

    pages[-1].extract_text(visitor_text=seen)
    words = [y for t, ys in heights.items() if not t.startswith(("v", "Page")) for y in ys]
    foot = 24 / 25.4 * 72  # the lower margin, points
    assert min(words) > foot
    assert len(pages) <= 2


def pages_of(blocks, folder):
    (folder / "r.pdf").write_bytes(pdf_of(Document("t", "r", "n", "v", tuple(blocks)), {}))
    return [page.extract_text() for page in PdfReader(folder / "r.pdf").pages]


def test_a_section_goes_on_where_little_of_a_page_is_taken(tmp_path):
    """Some 35 lines fill a page: 10 and 40 end in a page's upper half, 30 and 60 in its lower half."""
    for lines, begins in ((10, 0), (30, 1), (40, 1), (60, 2)):
        first = [Paragraph(f"line {i}") for i in range(lines)]
        pages = pages_of([*first, Break(), Heading("After")], tmp_path)
        on = [i for i, text in enumerate(pages) if "After" in text]
        ended = [i for i, text in enumerate(pages) if f"line {lines - 1}" in text]
        assert on == [begins], lines
        assert on[0] - ended[0] in (0, 1)


def test_the_whole_gear_has_its_section(tmp_path):
    write_report(tmp_path / "r.pdf", content())
    text, _ = text_of(tmp_path / "r.pdf")
    for words in ("The whole gear", "wave_generator.ball_count = 23 (usual)", "24 balls instead of 23",
                  "Gap without any clearance", "47.4", "60 % flexspline"):  # fmt: skip
        assert words in text, words


def test_a_gear_that_was_not_found_costs_only_its_section(tmp_path):
    missing = {"gear": Shortfall("the play takes the stroke")}
    write_report(tmp_path / "r.pdf", content(gear=None, missing=missing))
    text, _ = text_of(tmp_path / "r.pdf")
    assert "Not computed: the play takes the stroke." in text
    assert "84.6" in text


def test_no_total_is_taken_for_another(tmp_path):
    """Of two parts alone, or of the whole gear: the first page says it of each."""
    write_report(tmp_path / "r.pdf", content())
    first = re.sub(r"\s+", " ", PdfReader(tmp_path / "r.pdf").pages[0].extract_text())
    first = first.replace("( ", "(")  # pypdf 5.1 reads a blank before a link
    for words in ("Totals and terms.", "includes only flexspline and shaft", "of the whole gear (section 4)",
                  "clearances (section 3)", "friction are not included",
                  "twist between ±", "237.0 arcsec, and its lost motion include",
                  "rim contact and bearing"):  # fmt: skip
        assert words in first, words
    missing = {"gear": Shortfall("no equilibrium")}
    write_report(tmp_path / "r.pdf", content(gear=None, missing=missing))
    text, _ = text_of(tmp_path / "r.pdf")
    assert "a catalogue" not in text
    assert "twist between ±" not in text
    assert "Neither includes bolts" in text


def test_symbols_of_warnings_are_symbols_and_keys_are_whole():
    said = "K_e is wide, K_b,free too: K_b_Nm_per_rad"
    assert worded(said) == (
        *symbol("K_e"), *plain(" is wide, "), *symbol("K_b,free"), *plain(" too: K_b_Nm_per_rad"),
    )  # fmt: skip


def test_no_warning_has_a_bare_symbol(tmp_path):
    write_report(tmp_path / "r.pdf", content(warnings=("K_e is known to ± 4.8 %",)))
    text, _ = text_of(tmp_path / "r.pdf")
    assert "is known to ± 4.8 %" in text
    assert "K_e" not in text


def test_the_answers_stand_on_one_page(finished_cup):
    """The example's table of answers, its last row with them; the paragraph that follows is its end."""
    pages = [p.extract_text() for p in PdfReader(finished_cup.folder / "report.pdf").pages]
    (first,) = (p for p in pages if "Results. The bounds" in p)
    assert "shaft, load torque" in re.sub(r"\s+", " ", first)
    assert "Bounds" not in pages[pages.index(first) + 1].split("The backlash budget")[0]
