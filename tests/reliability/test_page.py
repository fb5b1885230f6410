"""The page of the rows: renewed one by one, kept where their test did not run."""

from __future__ import annotations

from collections import Counter

from reliability_page import Fact, counted, page, rows_of


def test_a_row_is_renewed_and_the_others_stay() -> None:
    first = page("", [Fact("test_files", f"from number {n}", n, "all", 1.0) for n in (1000, 500)])
    again = page(first, [Fact("test_files", "from number 500", 7, "renewed")])
    again = page(again, [Fact("test_size", "a million", 1, "solved", 2.345)])
    assert rows_of(again) == {
        "Files": [
            "| from number 500 | 7 | renewed |  |",
            "| from number 1000 | 1000 | all | 1 s |",
        ],
        "Size": ["| a million | 1 | solved | 2.35 s |"],
        "What was found and fixed": rows_of(first)["What was found and fixed"],
        "What this does not show": [],
    }
    assert page(again, []) == again


def test_outcomes_are_counted_in_one_order() -> None:
    assert counted(Counter(refused=2, answered=1)) == "1 answered, 2 refused"
    assert counted(Counter()) == "none"
