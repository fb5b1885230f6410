"""Names and units of a study's columns: figures from the one table, design keys from the schema."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from textwrap import fill
from typing import Any

from flexspline.geometry.schema import key_words
from flexspline.results.peaks import AT_BORDER, BORDER, at_border
from flexspline.results.quantities import BY_KEY, bounds_kind
from flexspline.results.quantity import Quantity

GUARANTEED = "_bounds_guaranteed"
"""End of the key of a row's mark: a number in the store, which holds nothing else."""
LISTED_DESIGNS = 5
"""The best ones, on the terminal and side by side in the report."""
COLUMN_LETTERS = 15
"""Of a name's line under a narrow column of a chart."""
_BOUND = {"[0]": "lower bound", "[1]": "upper bound"}
_UNSAID = ("flexspline", "gear", "bearing", "load", "material.flexspline")
"""Tables that a study's labels leave out."""


class _Dimension(Quantity):
    """A design key: as many digits as it needs, at most five."""

    def text(self, value: float) -> str:
        return f"{value:.5g}"


def entry(key: str) -> Quantity:
    """Name, unit and format of a figure or of a design key."""
    if key in BY_KEY:
        return BY_KEY[key]
    stem, bound = key[:-3], _BOUND.get(key[-3:])
    if bound and stem in BY_KEY:
        q = BY_KEY[stem]
        return Quantity(key, q.unit, f"{q.name}, {bound}", q.symbol, digits=q.digits)
    return _design_key(key)


def valued(key: str, figures: Mapping[str, float]) -> str:
    """A row's figure with its unit, and a mark where it is a peak that hangs on the stress rule."""
    return _marked(entry(key).with_unit(figures[key]), key, figures)


def beyond(key: str, figures: Mapping[str, float], ends: Iterable[float | None]) -> str:
    """`valued`, with as many digits as it takes to differ from the ends of a constraint."""
    q = entry(key)
    value = figures[key]
    printed = {q.text(end) for end in ends if end is not None and end != value}
    if q.text(value) not in printed:
        return valued(key, figures)
    exact = next(t for d in range(3, 18) if (t := f"{value:.{d}g}") not in printed)
    return _marked(f"{exact} {q.unit}".rstrip(), key, figures)


def _marked(text: str, key: str, figures: Mapping[str, float]) -> str:
    return f"{text} ({BORDER})" if at_border(key, figures) else text


def published(figures: Mapping[str, float]) -> dict[str, Any]:
    """A row's figures as result.json has them: what bounds are in a word, marks as true or false."""
    columns: dict[str, Any] = {}
    for key, value in figures.items():
        if key.endswith(GUARANTEED):
            columns[f"{key.removesuffix(GUARANTEED)}_bounds_kind"] = bounds_kind(bool(value))
        elif key.endswith(AT_BORDER):
            columns[key] = bool(value)
        else:
            columns[key] = value
    return columns


def _design_key(key: str) -> Quantity:
    """``flexspline.wall_thickness_mm`` → "wall thickness" in mm."""
    table, _, last = key.rpartition(".")
    name, unit = key_words(last)
    if table.startswith("material.") and table not in _UNSAID:
        name += f" of the {key_words(table.removeprefix('material.'))[0]}"
    elif table not in _UNSAID:
        name, unit = key_words(key)
    return _Dimension(key, unit, name)


def long_name(key: str) -> str:
    """A key in words, without unit, over two lines where it is long."""
    return _narrow(entry(key).name)


def axis_label(key: str) -> str:
    """Label of an axis: words, symbol and unit."""
    q = entry(key)
    words = f"{q.name.split(',')[0]} {q.mathtext}" if q.symbol else q.name
    return f"{words} in {q.unit}" if q.unit else words


def in_the_table(count: int, what: str) -> str:
    """What a chart has no room for."""
    return f"{count} more {what}{'s' * (count > 1)} in study.csv"


def lines_of(key: str) -> str:
    """A key under a narrow column: symbol or wrapped words, the unit below."""
    q = entry(key)
    return f"{q.mathtext if q.symbol else _narrow(q.name)}\n{q.unit}".strip()


def _narrow(name: str) -> str:
    return fill(name, COLUMN_LETTERS, break_long_words=False, break_on_hyphens=False)
