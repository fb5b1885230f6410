"""Lists in a sentence: all of a few, the ends of many."""

from __future__ import annotations

from flexspline.geometry.listed import FIRST_ENTRIES, MOST_ENTRIES, joined, listed


def test_a_few_are_all_listed() -> None:
    assert listed([3], "cycles") == "3"
    assert listed(range(1, MOST_ENTRIES + 1), "cycles") == "1, 2, 3, 4, 5, 6, 7, 8"


def test_many_are_counted() -> None:
    assert listed(range(1, 193), "cycles") == "1, 2, 3, … 192 (192 cycles)"
    assert listed("abcdefghi", "units").count(",") == FIRST_ENTRIES


def test_few_words_end_in_a_word() -> None:
    assert [joined("abc"[:n], "or") for n in range(4)] == ["", "a", "a or b", "a, b or c"]
