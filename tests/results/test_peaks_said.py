"""A peak that hangs on the stress rule: marked wherever it is shown, and compared with no limit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hand_made_gear import K_B, K_E, content, design
from page_text import letters, pdf_letters, read_page
from written_report import write_report

from flexspline.fea.types import StressPeak
from flexspline.geometry.design import Design
from flexspline.pipeline.linear_limit import LinearLimit, ReachedStress
from flexspline.pipeline.stiffnesses import Stiffnesses
from flexspline.pipeline.stress_limits import HIGHEST_STRENGTH_MPA, limits_passed, share_of_limit
from flexspline.results.console import table
from flexspline.results.peaks import BORDER
from flexspline.results.records import peak_record, stiffness_record
from flexspline.results.renders.picture_elements import stress_note
from flexspline.results.report.limits import assumptions
from flexspline.results.report.page import page_of
from flexspline.results.report.sections import run_document
from flexspline.results.report.tables import answers
from flexspline.results.studio.answer import message
from flexspline.results.warned import shortfalls

NAMES = ("wave_generator_peak", "torque_peak", "shaft_torque_peak")


def peak(mises_MPa: float, border: bool) -> StressPeak:
    """At r = 19.6 mm; 0.8 of it at twice the distance."""
    return StressPeak(
        mises_MPa,
        (19.6, 0.0, 21.4),
        "near edges",
        0.4,
        border,
        0.8 * mises_MPa if border else mises_MPa,
    )


def limited(limit_MPa: float | None) -> Design:
    """The hand-made cup with a fatigue limit, or without one."""
    steel = design().material.flexspline.model_copy(update={"fatigue_limit_MPa": limit_MPa})
    return design().model_copy(
        update={"material": design().material.model_copy(update={"flexspline": steel})}
    )


def stress_rows(mises_MPa: float, border: bool, limit_MPa: float | None = 500.0) -> list[dict]:
    each = peak(mises_MPa, border)
    said = content(
        design=limited(limit_MPa), wave_generator_peak=each, flexspline_peak=each, shaft_peak=each
    )
    return [row for row in answers(said) if row["unit"] == "MPa"]


def test_the_terminal_explains_the_mark_once() -> None:
    def said(border: bool) -> str:
        figures = {
            key: value
            for name in NAMES
            for key, value in peak_record(name, peak(400.0, border)).items()
        }
        return " ".join(table({"design": "a cup", **figures}, Path("out")).split())

    assert said(border=True).count("is not a measure of the part's strength") == 1
    assert "not a measure" not in said(border=False)


def test_the_first_table_marks_it_and_gives_no_share() -> None:
    for row in stress_rows(400.0, border=True):
        assert BORDER in row["note"]
        assert "0.4 mm" in row["note"]
        assert "320" in row["note"]  # MPa at twice the distance
        assert "% of the fatigue limit" not in row["note"]
    for row in stress_rows(400.0, border=False):
        assert BORDER not in row["note"]
        assert "80 % of the fatigue limit of 500 MPa" in row["note"]


def test_the_first_table_says_a_limit_that_is_passed_and_one_that_is_absent() -> None:
    assert all(row["alarm"] == "" for row in stress_rows(400.0, border=False))
    passed = [row["alarm"] for row in stress_rows(600.0, border=False)]
    assert passed == ["above the fatigue limit of 500 MPa"] * 3
    bare = stress_rows(2 * HIGHEST_STRENGTH_MPA, border=False, limit_MPa=None)
    assert all("no fatigue limit stated" in row["note"] for row in bare)
    assert all("above 2000 MPa" in row["alarm"] for row in bare)


@pytest.mark.parametrize("name", NAMES)
def test_a_peak_of_the_rule_has_no_share_of_a_limit(name: str) -> None:
    steel = limited(500.0).material.flexspline
    assert share_of_limit(peak(400.0, border=True), steel) is None
    assert share_of_limit(peak(400.0, border=False), steel) == pytest.approx(0.8)
    # under torque it passes none either; on the ellipse the stress is at least what is reported
    found = list(limits_passed(limited(500.0), {name: peak(3000.0, border=True)}))
    assert bool(found) == (name == "wave_generator_peak")


def test_reports_carry_mark_alarm_seat_and_torque(tmp_path: Path) -> None:
    said = content(
        wave_generator_peak=peak(600.0, border=True),
        flexspline_peak=peak(30.0, border=True),
        half_seat_peak=peak(450.0, border=False),
        linear_limit=LinearLimit(
            88.1, ReachedStress("flexspline", "diaphragm", 9.0, 500.0, is_fatigue_limit=True)
        ),
    )
    write_report(tmp_path / "r.pdf", said)
    page, *_ = read_page(page_of(run_document(said), {}, {}).decode())
    for text in (pdf_letters(tmp_path / "r.pdf"), page):
        for words in (
            BORDER, "not a measure of the part", "above the fatigue limit of 500 MPa",
            "as wide as the toothed ring, 8 mm", "4 mm in the middle of the ring", "450", "-25 %",
            "not valid beyond 88.1", "T_L is 0.57 % of this limit",
            "the diaphragm at r = 9 mm under torque alone reaches the fatigue limit",
        ):  # fmt: skip
            assert letters(words.replace("T_L", "")) in letters(text.replace("T_L", "")), words
        assert letters("% of the stated fatigue limit") not in letters(text)


def test_json_console_and_page_mark_it(tmp_path: Path) -> None:
    found = Stiffnesses({"K_b": K_B, "K_e": K_E}, wave_generator_peak=peak(400.0, border=True))
    record = {"design": "", **stiffness_record(limited(500.0), found, 1.0)}
    record |= peak_record("torque_peak", peak(3.0, border=False))
    record |= peak_record("shaft_torque_peak", peak(4.0, border=True))
    assert record["wave_generator_peak_at_excluded_border"] is True
    assert record["torque_peak_at_excluded_border"] is False
    assert record["wave_generator_peak_excluded_mm"] == 0.4
    assert record["wave_generator_peak_mises_at_twice_excluded_MPa"] == 320.0
    lines = [line for line in table(record, tmp_path).splitlines() if "Peak von Mises" in line]
    assert [BORDER in line for line in lines] == [True, False, True]
    rows = message(limited(500.0), record)["peaks"]
    assert [BORDER in row.get("more", "") for row in rows] == [True, False, True]
    assert [row["limit"] for row in rows] == [BORDER, "0.6 % of 500", BORDER]
    assert not any(row["over"] for row in rows)


def test_pictures_say_where_their_colours_end() -> None:
    assert "0.4 mm from sharp edges" in stress_note(peak(400.0, border=True), beyond=True)
    assert "0.4 mm" not in stress_note(peak(400.0, border=False), beyond=True)


def test_a_passed_limit_is_a_warning() -> None:
    found = Stiffnesses({"K_b": K_B, "K_e": K_E}, wave_generator_peak=peak(600.0, border=True))
    (line,) = shortfalls(limited(500.0), found)
    assert line.startswith("Peak von Mises stress, wave-generator ellipse: 600")
    assert "above the fatigue limit of 500 MPa (material.flexspline.fatigue_limit_MPa)" in line
    assert "still rises" in line
    kept = replace(found, wave_generator_peak=peak(490.0, border=True))
    assert shortfalls(limited(500.0), kept) == ()
    assert "no metal used in gears is elastic" in " ".join(
        shortfalls(limited(None), replace(found, wave_generator_peak=peak(2858.0, border=True)))
    )


def test_the_page_hears_of_a_torque_beyond_the_linear_model() -> None:
    found = {"K_b_Nm_per_rad": 3e4, "K_e_Nm_per_rad": 4e4}
    heavy = design().model_copy(
        update={"load": design().load.model_copy(update={"torque_Nm": 5000.0})}
    )
    (line,) = message(heavy, found)["beyond"]
    assert "load.torque_Nm = 5000 exceeds" in line
    assert message(design(), found)["beyond"] == []
    assert "beyond" not in message(heavy, {})  # nothing is known of K yet


def test_the_half_seat_is_compared_with_the_whole_seat_of_the_same_model() -> None:
    """A solid peak of 234 MPa; without holes 248 MPa, and 247 MPa on half the seat: not 6 % more."""
    said = content(
        wave_generator_peak=peak(234.0, border=True),
        half_seat_peak=peak(247.3, border=True),
        full_seat_peak=peak(247.9, border=True),
    )
    (words,) = (text for name, text in assumptions(said) if name == "Wave generator")
    assert (
        "247\u202fMPa instead of 248\u202fMPa (−0.2 %; both without bolt holes, at excluded"
        in words
    )
    (note,) = (row["note"] for row in answers(said) if row["value"] == "234")
    assert (
        "without bolt holes 248\u202fMPa, and 247\u202fMPa with a seat half as wide (at exc" in note
    )


def test_the_half_seat_is_marked_where_every_peak_is(tmp_path: Path) -> None:
    found = Stiffnesses(
        {"K_b": K_B, "K_e": K_E},
        wave_generator_peak=peak(234.0, border=False),
        half_seat_peak=peak(247.3, border=True),
        full_seat_peak=peak(247.9, border=True),
    )
    record = {"design": "", **stiffness_record(limited(500.0), found, 1.0)}
    assert record["wave_generator_peak_half_seat_mises_MPa"] == 247.3
    assert record["wave_generator_peak_half_seat_at_excluded_border"] is True
    assert record["wave_generator_peak_half_seat_excluded_mm"] == 0.4
    assert record["wave_generator_peak_without_holes_mises_MPa"] == 247.9
    said = table(record, tmp_path)
    (line,) = (line for line in said.splitlines() if "seat half as wide" in line)
    assert "248\u202fMPa on the whole seat" in line
    assert BORDER in line
    row = message(limited(500.0), record)["peaks"][0]
    assert "on a seat half as wide (at excluded border)" in row["more"]
