"""Numbers as the report prints them and as the page of the studio does."""

from __future__ import annotations

from importlib.resources import files

import pytest
from browser import chromium

from flexspline.results.numbers import THIN, grouped
from flexspline.results.page_3d.script import in_function

GROUPED = [
    (44712.34, 0, f"44{THIN}712"),
    (9999.4, 0, "9999"),
    (9999.7, 0, f"10{THIN}000"),
    (9999.7, 1, "9999.7"),
    (9999.96, 1, f"10{THIN}000.0"),
    (-9999.7, 0, f"−10{THIN}000"),
    (1234567.0, 1, f"1{THIN}234{THIN}567.0"),
    (-3.26, 1, "−3.3"),
    (-0.04, 1, "0.0"),
    (0.0, 2, "0.00"),
]


@pytest.mark.parametrize(("value", "decimals", "text"), GROUPED)
def test_grouping(value: float, decimals: int, text: str) -> None:
    assert grouped(value, decimals) == text


def test_the_page_of_the_studio_groups_alike() -> None:
    module = files("flexspline.results.studio") / "page" / "dom.js"
    script = in_function("dom.js", module.read_text(encoding="utf-8"))
    asked = "cases.map(([value, decimals]) => dom_js.grouped(value, decimals))"
    with chromium() as browser:
        said = browser.new_page().evaluate(f"cases => {{ {script} return {asked}; }}", GROUPED)
    assert said == [text for _, _, text in GROUPED]
