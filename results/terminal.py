"""Lines of an answer that fit the terminal, or the width that COLUMNS asks for."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Sequence

TEXT_WIDTH = 96
"""Letters of a line of prose at most: longer ones are hard to read."""
UNBOUNDED_COLUMNS = 10_000
"""Width of what is no terminal: a file or a pipe takes rows of any length."""
LEAST_WIDTH = 24
"""Narrower ones are not obeyed: the longest words would not fit."""
DEEPER = "    "
"""Of what follows on lines of its own."""


def width() -> int:
    """Letters that a line may have."""
    return max(shutil.get_terminal_size((UNBOUNDED_COLUMNS, 24)).columns, LEAST_WIDTH)


def prose(
    text: str, first: str = "  ", rest: str | None = None, most: int = TEXT_WIDTH
) -> list[str]:
    """Lines of a paragraph that begin with `first`, and with `rest` after the first one."""
    after = first if rest is None else rest
    return textwrap.wrap(text, min(most, width()), initial_indent=first, subsequent_indent=after)


def row(cells: Sequence[str], widths: Sequence[int] = (), indent: str = "  ") -> list[str]:
    """Cells side by side, each but the last in a column that wide; where too long, one below the other."""
    padded = [f"{cell:<{w}}" for cell, w in zip(cells, widths, strict=False)]
    line = (indent + " ".join([*padded, *cells[len(widths) :]])).rstrip()
    if len(line) <= width():
        return [line]
    first, *others = cells
    deeper = indent + DEEPER
    below = (part for cell in others for part in prose(cell, deeper, most=UNBOUNDED_COLUMNS))
    return [*prose(first, indent, deeper, UNBOUNDED_COLUMNS), *below]
