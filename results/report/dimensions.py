"""All values of a design file, so that the same model can be built again."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from typing import Any

from flexspline.geometry.design import Design
from flexspline.geometry.mass import masses
from flexspline.geometry.schema import key_words
from flexspline.results.doubt import NOT_STATED
from flexspline.results.quantities import quantity
from flexspline.results.report.document import Block, Facts, Heading, Paragraph
from flexspline.results.report.spans import NBSP, Words, bold, plain


def dimensions(design: Design) -> Iterable[Block]:
    """Every key of the design file with its value and unit, defaults included, by table."""
    yield Heading("Values of the design", "figures")
    yield Paragraph("Every key of the design file that has a value, defaults included.", small=True)
    yield Facts(tuple((name, _values_in_words(name, table)) for name, table in _tables(design)))


def ratio(design: Design) -> str:
    """``100 : 1``, wave generator to flexspline while the circular spline stands still."""
    return f"{_number(design.gear.ratio)} : 1"


def weights(design: Design) -> str:
    """Mass of both parts."""
    m = masses(design)
    grams = (("flexspline", m.flexspline_g), ("shaft", m.shaft_g))
    printed = (f"{name} {quantity(f'{name}_mass_g').with_unit(g)}" for name, g in grams)
    return f"{', '.join(printed)}; without teeth"


def _tables(design: Design) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """The file's tables in its order, the shaft's segments one by one, by the names that keys have."""
    whole: Mapping[str, Any] = design.tables
    for name, table in whole.items():
        if not isinstance(table, dict):
            continue
        first = {"kind": table["kind"]} if "kind" in table else {}
        values = first | {k: v for k, v in table.items() if not isinstance(v, dict | list)}
        if values:
            yield name, values
        for inner, deeper in table.items():
            if isinstance(deeper, dict):
                yield f"{name}.{inner}", deeper
            elif isinstance(deeper, list):
                yield from ((f"{name}.{inner}[{i}]", entry) for i, entry in enumerate(deeper))


def _values_in_words(name: str, table: Mapping[str, Any]) -> Words:
    """``length 30 mm, …``; the figures stand out. A deviation of 0 states nothing."""
    silent = name == "uncertainty"
    spans = (
        (plain(", ") if i else ())
        + plain(f"{key_words(key)[0]} ")
        + bold(NOT_STATED if silent and not value else _value(key, value))
        for i, (key, value) in enumerate(table.items())
    )
    return tuple(chain.from_iterable(spans))


def _value(key: str, value: Any) -> str:
    if not isinstance(value, int | float):
        return str(value)
    _, unit = key_words(key)
    return f"{_number(value)}{NBSP}{unit}" if unit else _number(value)


def _number(value: float) -> str:
    """As short as it can be without losing a digit."""
    return f"{value:.12g}".replace("-", "\N{MINUS SIGN}")
