"""Rows and paragraphs as wide as the terminal."""

from __future__ import annotations

import pytest

from flexspline.results.terminal import TEXT_WIDTH, prose, row

CELLS = ("Bounds of the flexspline stiffness (uniform)", "31 268 to 31 356 N·m/rad, guaranteed")


@pytest.fixture
def narrow(monkeypatch: pytest.MonkeyPatch) -> int:
    monkeypatch.setenv("COLUMNS", "40")
    return 40


def test_a_file_or_a_pipe_takes_rows_of_any_length(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("COLUMNS", raising=False)
    assert row(CELLS, (64,)) == [f"  {CELLS[0]:<64} {CELLS[1]}"]
    assert max(map(len, prose("word " * 100))) <= TEXT_WIDTH


def test_no_line_is_wider_and_no_word_is_lost(narrow: int) -> None:
    lines = row(CELLS, (64,))
    assert max(map(len, lines)) <= narrow
    assert " ".join(" ".join(lines).split()) == " ".join(CELLS)
    text = "a paragraph of several words that does not fit"
    assert max(map(len, prose(text))) <= narrow
    assert " ".join(" ".join(prose(text)).split()) == text


def test_what_fits_stays_side_by_side(narrow: int) -> None:
    assert row(("Part solved", "1/12"), (20,)) == [f"  {'Part solved':<20} 1/12"]


def test_a_width_of_nonsense_is_not_obeyed(monkeypatch: pytest.MonkeyPatch) -> None:
    for width in ("0", "1", "wide", "-5"):
        monkeypatch.setenv("COLUMNS", width)
        assert all(len(line) > 10 for line in row(CELLS, (64,))[:1])
