"""What a design's file does not state is said to be not stated: no figure stands in for it."""

import json
import re
from pathlib import Path

import pytest
from hand_made_gear import content, design
from page_text import letters, pdf_letters, read_page
from unlike_gears import GEARS
from written_report import write_report

from flexspline.geometry.design import Design
from flexspline.pipeline.backlash import backlash
from flexspline.pipeline.diagnosis.prediction import prediction_of
from flexspline.pipeline.study.load import study_from
from flexspline.pipeline.study.study import StudyError
from flexspline.results.console import table
from flexspline.results.doubt import missing, spread_sentence
from flexspline.results.records import as_json, backlash_record
from flexspline.results.report.page import page_of
from flexspline.results.report.sections import run_document
from flexspline.results.studio.answer import message

SILENT, PART, FULL = GEARS["no uncertainty"], GEARS["one source"], GEARS["cup"]
ZERO = re.compile(r"±\s*0(\.0)?(?![.\d])")


def report_of(gear):
    return content(design=gear.design, backlash=gear.backlash)


def printed(gear, folder):
    """Letters of the PDF and of the page."""
    write_report(folder / "r.pdf", report_of(gear))
    shown, _, _ = read_page(page_of(run_document(report_of(gear)), {}).decode())
    return pdf_letters(folder / "r.pdf"), shown


def test_a_report_without_uncertainty_says_so(tmp_path):
    for text in printed(SILENT, tmp_path):
        assert text.count(letters("not stated")) >= 3  # tile, answers, clearances
        assert letters("the design file states no uncertainty") in text
        assert not ZERO.search(text)


def test_a_report_says_which_part_is_stated(tmp_path):
    for text in printed(PART, tmp_path):
        assert letters("with Young's modulus and bearing play not stated") in text
        assert letters("young's") not in text
        assert letters("± 11.0 (1σ, flank clearance only)") in text
        assert not ZERO.search(text)


def test_a_whole_statement_leaves_nothing_out():
    assert missing(FULL.backlash) == ()
    assert "not stated" not in spread_sentence(FULL.backlash)


def test_a_terminal_says_which_part_is_stated():
    for gear, said in ((PART, " arcsec, flank clearance only"), (FULL, " arcsec\n")):
        record = {"design": "d", **backlash_record(gear.backlash)}
        _, _, line = table(record, Path()).partition("Standard deviation of the total")
        assert f"{gear.backlash.std_arcsec:.1f}{said}" in line.replace(
            "\N{NARROW NO-BREAK SPACE}", " "
        )


def test_the_record_has_no_deviation_that_was_not_computed():
    record = json.loads(as_json(backlash_record(SILENT.backlash)))
    assert set(record["backlash_arcsec"]) == {
        "shaft", "flexspline", "flank_clearance", "bearing_play", "total",
    }  # fmt: skip
    assert "backlash_std_by_source_arcsec" not in record
    part = backlash_record(PART.backlash)
    assert set(part["backlash_std_by_source_arcsec"]) == {"flank_clearance"}
    assert part["backlash_arcsec"]["std"] == pytest.approx(10.98, abs=0.01)  # 2 · 1 µm/(m z1 cos α)


def test_the_console_says_not_stated(tmp_path):
    said = table({"design": "x", **backlash_record(SILENT.backlash)}, tmp_path)
    (line,) = (s for s in said.splitlines() if "Standard deviation" in s)
    assert line.split()[-2:] == ["not", "stated"]
    stated = table({"design": "x", **backlash_record(FULL.backlash)}, tmp_path)
    assert "not stated" not in stated
    assert "not stated" not in table({"design": "x"}, tmp_path)  # no backlash, no word about it


def test_the_page_gets_words_and_no_row():
    K = {"K_b_Nm_per_rad": SILENT.K_b, "K_e_Nm_per_rad": SILENT.K_e}
    budget = message(SILENT.design, K)["budget"]
    assert [r["key"].rpartition(".")[2] for r in budget["rows"]][-1] == "total"
    assert budget["spread"] == "1σ not stated"
    assert {text for _, text in budget["sources"]} == {"not stated"}
    assert message(FULL.design, K)["budget"]["spread"].startswith("± ")


def test_a_zero_states_nothing():
    zeros = {"youngs_modulus_pct": 0.0, "flank_clearance_um": 0.0, "radial_clearance_um": 0.0}
    tables = design().model_dump(exclude_none=True) | {"uncertainty": zeros}
    assert backlash(Design.model_validate(tables), 3e4, 3e4).std_arcsec is None


def test_a_diagnosis_without_uncertainty_takes_the_design_as_exact():
    found = prediction_of(SILENT.design, SILENT.K_b, SILENT.K_e)
    assert (found.compliance_std, found.gap_std_arcsec) == (0.0, 0.0)


def test_a_study_of_a_deviation_that_nothing_states_is_refused(tmp_path):
    text = (
        'name = "x"\n[flexspline]\nkind = "cup"\ninner_diameter_mm = 38.4\nwall_thickness_mm = 0.4\n'
        "ring_thickness_mm = 0.55\nlength_mm = 30.0\nring_width_mm = 8.0\n"
        "diaphragm_thickness_mm = 0.6\nboss_diameter_mm = 18.0\nboss_thickness_mm = 3.0\n"
        "[shaft]\ngrip_length_mm = 10.0\n[[shaft.segment]]\nlength_mm = 24.0\n"
        'outer_diameter_mm = 17.0\n[material.flexspline]\nname = "s"\nyoungs_modulus_GPa = 206.0\n'
        "poissons_ratio = 0.3\n[gear]\nmodule_mm = 0.2\nteeth_flexspline = 200\n"
        "teeth_circular_spline = 202\npressure_angle_deg = 20.0\nflank_clearance_um = 3.0\n"
        "[bearing]\nradial_clearance_um = 12.0\n[load]\ntorque_Nm = 0.5\n"
    )
    (tmp_path / "d.toml").write_text(text)
    asked = {
        "design": "d.toml",
        "vary": {"flexspline.length_mm": {"min": 20.0, "max": 40.0}},
        "objective": {"backlash_arcsec.std": "minimize"},
    }
    with pytest.raises(StudyError, match="standard deviation above 0"):
        study_from(asked, tmp_path, "s")
    span = {"uncertainty.flank_clearance_um": {"min": 0.0, "max": 2.0}}
    with pytest.raises(StudyError, match="standard deviation above 0"):
        study_from(asked | {"vary": span}, tmp_path, "s")
    span = {"uncertainty.flank_clearance_um": {"min": 0.5, "max": 2.0}}
    study_from(asked | {"vary": span}, tmp_path, "s")


def test_the_design_in_figures_says_what_is_not_stated(tmp_path):
    for text in printed(PART, tmp_path):
        for words in (
            "Young's modulus not stated", "flank clearance 1 µm", "radial clearance not stated",
        ):  # fmt: skip
            assert letters(words) in text
