"""Lines among the rows that hold no reading: the head and its units again, and the columns' data types."""

from __future__ import annotations

from collections.abc import Sequence

_TYPES = {
    "float", "float32", "float64", "double", "single", "real", "number", "numeric", "decimal", "int", "int16",
    "int32", "int64", "integer", "long", "uint16", "uint32", "uint64", "bool", "string", "str", "text",
    "char", "varchar", "datetime", "timestamp", "date", "time",
}  # fmt: skip
"""What programs call the type of a column."""


def heads_again(
    head: Sequence[str], units: Sequence[str], rows: Sequence[Sequence[str]]
) -> tuple[int, ...]:
    """Places of the rows that repeat the head, with the lines of units and types that belong to it."""
    lines_again: list[int] = []
    under_head = True
    for i, row in enumerate(rows):
        again = row[0].strip() == head[0] and _same(row, head)
        under_head = again or (under_head and (_are_types(row) or _same(row, units)))
        if under_head:
            lines_again.append(i)
    return tuple(lines_again)


def _same(row: Sequence[str], known: Sequence[str]) -> bool:
    return any(known) and _bare(row) == _bare(known)


def _bare(row: Sequence[str]) -> list[str]:
    """Texts without what is empty at the end."""
    texts = [cell.strip() for cell in row]
    while texts and not texts[-1]:
        texts.pop()
    return texts


def _are_types(row: Sequence[str]) -> bool:
    words = [cell.strip().lower().strip("[]()") for cell in row if cell.strip()]
    return len(words) > 1 and all(w in _TYPES for w in words)
