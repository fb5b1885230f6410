"""Which line of a measured file is the head: the one that names the most quantities."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from flexspline.pipeline.diagnosis.measurement.column_names import column_name, is_unit
from flexspline.pipeline.diagnosis.measurement.number_text import number_of
from flexspline.pipeline.diagnosis.measurement.time_stamps import is_stamp
from flexspline.pipeline.diagnosis.measurement.units import QUANTITIES

HEAD_LINES = 300
"""Lines among which the head is searched. Programs write up to some 50 lines above it, most of them one for
each channel."""
A_UNIT, SURE_NAME = 0.5, 1.0
"""Points of a cell as part of a head: a unit alone counts half as much as a certain name. Judgement."""
OUR_NAME = A_UNIT + SURE_NAME
"""A name as this program writes it says both."""


@dataclass(frozen=True)
class Head:
    """A line that may be the head, with its separator and how much of it is known."""

    at: int
    separator: str
    cells: list[str]
    units: list[str]
    score: float


LineSplitter = Callable[[int, str], list[str]]


def head_of(count: int, split: LineSplitter, separators: tuple[str, ...]) -> Head:
    """The line above the first row of numbers that names the most quantities; the first line for none.

    Of equals the last is taken: notes stand further up.
    """
    widest = max(separators, key=lambda s: len(split(0, s)))
    best = Head(0, widest, split(0, widest), [], 0.0)
    for i in range(min(count, HEAD_LINES)):
        if best.score > 0 and _is_data(best, split(i, best.separator)):
            break
        for separator in separators:
            cells = split(i, separator)
            below = split(i + 1, separator) if i + 1 < count else []
            units = below if _are_units(cells, below) else []
            score = sum(_worth(with_unit(*pair)) for pair in paired(cells, units))
            if score >= max(best.score, A_UNIT):
                # of equals in one line the first separator stays
                if score == best.score and best.at == i:
                    continue
                best = Head(i, separator, cells, units, score)
    return best


def with_unit(head: str, unit: str) -> str:
    """A head with the unit that stands below it."""
    bare = unit.strip().strip("[](){}<>")
    return f"{head} [{bare}]" if bare not in ("", "-", "–") else head


def paired(cells: list[str], units: list[str]) -> list[tuple[str, str]]:
    """Each head with what stands below it; "" where the row of units is shorter."""
    below = units + [""] * (len(cells) - len(units))
    return list(zip(cells, below, strict=False))


def _worth(head: str) -> float:
    name = column_name(head)
    if name is None:
        return 0.0
    if name.ours:
        return OUR_NAME
    return (SURE_NAME if name.sure else 0.0) + (A_UNIT if name.unit else 0.0)


def _are_units(head: list[str], below: list[str]) -> bool:
    """Whether a row holds units: one at least is known, and no quantity has a number."""
    if not 1 < len(below) <= len(head) or not any(is_unit(c) for c in below):
        return False
    return not any(
        number_of(c, mark) is not None or is_stamp(c) for c in below for mark in (".", ",")
    )


def _is_data(head: Head, cells: list[str]) -> bool:
    """Whether a row has numbers in the columns that the head says are numbers."""
    measured = [
        cell
        for (name, unit), cell in zip(paired(head.cells, head.units), cells, strict=False)
        if (column := column_name(with_unit(name, unit))) is not None
        and column.quantity in QUANTITIES
    ]
    return any(measured) and all(
        not c or number_of(c, ".") is not None or number_of(c, ",") is not None or is_stamp(c)
        for c in measured
    )
