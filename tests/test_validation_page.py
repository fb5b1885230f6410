"""The validation page has every case that the verification tests assert."""

from __future__ import annotations

from math import inf
from pathlib import Path

import pytest
from validation_page import HEAD, TOPICS, Row, has_case, markdown

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")
MODULES = sorted((ROOT / "tests" / "verification").glob("test_*.py"))
ROWS = [
    Row("test_nafems_le1", "one number", "a book", 92.7, 92.75, "MPa"),
    Row("test_nafems_le1", "a small one", "a book", -1.8248e-5, -1.8248e-5, "m", 5),
    Row("test_source_article", "a range", "a paper", (0.3, 3.0), 4.0),
    Row("test_source_article", "from below", "a paper", (3.0, inf), 3.9),
    Row("test_nafems_le10", "nothing", "logic", 0.0, 3e-16),
]


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.stem)
def test_every_verification_test_hands_in_its_cases(path: Path) -> None:
    topics = [topic for topic, modules in TOPICS.items() if path.stem in modules]
    assert len(topics) == 1, f"{path.stem} belongs under one heading of validation_page.TOPICS"
    assert "record(" in path.read_text(encoding="utf-8")
    section = PAGE.split(f"## {topics[0]}\n")[1].split("\n## ")[0]
    assert f"{path.stem}.py" in section
    assert section.count("\n| ") > 1  # the heading row and at least one case


def test_the_page_is_the_commands() -> None:
    assert PAGE.startswith(HEAD)
    assert [line[3:] for line in PAGE.splitlines() if line.startswith("## ")] == list(TOPICS)


def test_the_text_has_every_case_under_its_heading() -> None:
    page = markdown(ROWS)
    assert all(has_case(page, row) for row in ROWS)
    assert not has_case(page, Row("test_nafems_le1", "another", "a book", 1.0, 1.0))
    elsewhere = Row("test_source_article", "one number", "a book", 92.7, 92.75, "MPa")
    assert not has_case(page, elsewhere)
    assert markdown([*ROWS, elsewhere]).count("| one number |") == 2
    lines = page.splitlines()
    assert "| one number | a book | 92.7 MPa | 92.75 MPa | +0.05 % |" in lines
    assert "| a small one | a book | −1.8248e−05 m | −1.8248e−05 m | < 0.01 % |" in lines
    assert "| a range | a paper | 0.3 to 3 | 4 | outside |" in lines
    assert "| from below | a paper | ≥ 3 | 3.9 | within |" in lines
    assert "| nothing | logic | 0 | 0 | rounding |" in lines
    assert page.index("## The backlash sum") < page.index("a range") < page.index("one number")


def test_a_case_is_recorded_once() -> None:
    with pytest.raises(ValueError, match="one number"):
        markdown([ROWS[0], ROWS[0]])


def test_a_module_without_a_heading_is_refused() -> None:
    with pytest.raises(ValueError, match="test_unheard_of"):
        markdown([Row("test_unheard_of", "case", "a book", 1.0, 1.0)])
