"""What bounds are called, in every place where a person or a program reads them.

By hand: stiffnesses of every kind, so that no solver is asked and the words alone are tested.
"""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from hand_made_gear import K_B, K_E, content, design
from page_text import letters, pdf_letters, read_page
from written_report import write_report

from flexspline.fea.types import Stiffness
from flexspline.pipeline.stiffnesses import Stiffnesses
from flexspline.results.console import table
from flexspline.results.quantities import bounds_kind
from flexspline.results.records import stiffness_record
from flexspline.results.report.page import page_of
from flexspline.results.report.sections import run_document
from flexspline.results.report.tables import UNCHECKED, solves
from flexspline.results.studio.answer import message

FIGURES = ("K_b", "K_b_lobes", "K_b_lobes_contact", "K_b_lobes_unsupported", "K_e")
ESTIMATE = replace(K_E, guaranteed=False, method="recovery estimate")
"""Solved on the meridian, and yet no theorem: what the lobe cases are."""
GUARANTEE = letters("These bounds are proven")


def found(guaranteed: tuple[str, ...]) -> Stiffnesses:
    kinds = {name: K_E if name in guaranteed else ESTIMATE for name in FIGURES}
    return Stiffnesses(kinds)


def said_of(stiffnesses: Stiffnesses):
    return content(stiffnesses=stiffnesses)


CASES = [(), ("K_b",), ("K_e",), ("K_b", "K_e")]


@pytest.mark.parametrize("guaranteed", CASES)
def test_json_and_console_name_the_kind_of_each(guaranteed, tmp_path) -> None:
    record = {"design": "", **stiffness_record(design(), found(guaranteed), 1.0)}
    kinds = {name: record[f"{name}_bounds_kind"] for name in FIGURES}
    assert kinds == {n: "guaranteed" if n in guaranteed else "estimated" for n in FIGURES}
    lines = [line for line in table(record, tmp_path).splitlines() if "Bounds of" in line]
    assert len(lines) == len(FIGURES)
    assert sum(line.endswith(", guaranteed") for line in lines) == len(guaranteed)
    assert sum(line.endswith(", estimated") for line in lines) == len(FIGURES) - len(guaranteed)


@pytest.mark.parametrize("guaranteed", CASES)
def test_reports_call_nothing_guaranteed_that_is_estimated(guaranteed, tmp_path) -> None:
    told = said_of(found(guaranteed))
    write_report(tmp_path / "r.pdf", told)
    page, *_ = read_page(page_of(run_document(told), {}, {}).decode())
    for said in (pdf_letters(tmp_path / "r.pdf"), letters(" ".join(page))):
        # the series stiffness, in a tile and in the table, is between theorems only if both parts are
        series = 2 * (len(guaranteed) == 2)
        assert said.count("guaranteed") == len(guaranteed) + series
        assert said.count("estimated") == len(FIGURES) - len(guaranteed) + 2 - series
        assert (GUARANTEE in said) == bool(guaranteed)
        assert letters("estimate, not a guarantee") in said  # of the lobes at least


@pytest.mark.parametrize("guaranteed", CASES)
def test_the_studio_page_gets_the_kind_of_each(guaranteed) -> None:
    record = stiffness_record(design(), found(guaranteed), 1.0)
    rows = {row["key"]: row for row in message(design(), record)["stiffness"]}
    for name in FIGURES:
        kind = bounds_kind(name in guaranteed)
        assert rows[f"{name}_Nm_per_rad"]["half_pct"].endswith(f", {kind}")


def test_a_check_that_nobody_made_is_not_printed() -> None:
    unchecked = tuple(
        replace(level, K_check_Nm_per_rad=None, residual=None) for level in K_B.levels
    )
    unchecked_K = replace(K_B, levels=unchecked)
    solved = Stiffnesses({"K_b": K_B, "K_b_lobes_contact": unchecked_K})
    rows = {row["symbol"]: row for row in solves(content(stiffnesses=solved))}
    assert (rows["K_b,contact"]["residual"], rows["K_b,contact"]["energy"]) == (UNCHECKED,) * 2
    assert re.fullmatch(r"3·10⁻¹³", rows["K_b"]["residual"])


def test_half_width_is_half_of_the_distance_over_k() -> None:
    k: Stiffness = replace(K_B, K_Nm_per_rad=100.0, lower_Nm_per_rad=98.0, upper_Nm_per_rad=101.0)
    assert k.half_width == pytest.approx(0.015)
    assert k.bounds_Nm_per_rad == (98.0, 101.0)
