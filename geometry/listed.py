"""Short lists for sentences."""

from __future__ import annotations

from collections.abc import Iterable

MOST_ENTRIES = 8
"""Entries that are all written out; they fill half a line of a console."""
FIRST_ENTRIES = 3
"""Entries of a longer list that are written out before its last: they show its step."""


def joined(words: Iterable[str], last: str) -> str:
    """All of a few, with commas between and a word before the last.

    >>> joined(["bore", "boss"], "and"), joined(["1", "2", "3"], "or")
    ('bore and boss', '1, 2 or 3')
    """
    texts = list(words)
    if len(texts) > 1:
        texts[:-1] = [", ".join(texts[:-1])]
    return f" {last} ".join(texts)


def listed(words: Iterable[object], what: str) -> str:
    """The entries with commas between; of a long list the first and the last, and how many there are.

    >>> listed([2, 5, 8], "cycles")
    '2, 5, 8'
    >>> listed(range(1, 193), "cycles")
    '1, 2, 3, … 192 (192 cycles)'
    """
    texts = [str(w) for w in words]
    if len(texts) <= MOST_ENTRIES:
        return ", ".join(texts)
    return f"{', '.join(texts[:FIRST_ENTRIES])}, … {texts[-1]} ({len(texts)} {what})"
