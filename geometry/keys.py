"""Design keys as dotted names: read, replaced, listed."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import design_from
from flexspline.geometry.part import Part
from flexspline.geometry.ranges import is_number
from flexspline.geometry.schema import Location

PLACE = re.compile(r"\d{1,9}")
"""Of an array's element, counted from 0."""
IN_BRACKETS = re.compile(rf"\[({PLACE.pattern})\]")
WITH_DEFAULTS = (("material", "circular_spline"), ("material", "bearing"))
"""Tables that may be missing although their keys have values: one key of them makes the table."""
HOLES = ("bolt_circle_diameter_mm", "bolt_hole_diameter_mm")
"""Not in the meridian: no sensitivity without holes."""


def value_at(design: Design, key: str) -> float | None:
    """The number at a dotted key, None where it is absent or no number."""
    try:
        table, last = _reach(design.tables, key)
    except DesignError:
        return None
    value = table.get(last) if isinstance(table, dict) else None
    return float(value) if is_number(value) else None


def has_table_of(design: Design, key: str) -> bool:
    """Whether the table of a dotted key is there, the key itself stated or left to its default."""
    try:
        _reach(design.tables, key)
    except DesignError:
        return False
    return True


def with_values(design: Design, values: Mapping[str, object]) -> Design:
    """A checked design with other values at some keys; array elements are counted from 0.

    Raises
    ------
    DesignError : no such key, a value out of range, or impossible geometry.
    """
    if not isinstance(values, Mapping) or not all(isinstance(key, str) for key in values):
        raise DesignError(
            "values", values, 'must be a table such as {"flexspline.length_mm": 35.0}'
        )
    tables = design.tables
    for key, value in values.items():
        table, last = _reach(tables, key, value)
        if hasattr(
            value, "tolist"
        ):  # numpy's numbers, and its arrays, which are refused as lists are
            value = value.tolist()
        # what the file does not state may be a whole number as well
        if isinstance(table.get(last, 0), int) and isinstance(value, float) and value.is_integer():
            value = int(value)
        table[last] = value
    return design_from(tables)


def lengths(part: Part) -> dict[str, float]:
    """Dotted keys of all lengths above 0 [mm] that a part's meridian has."""
    table = part.shape.model_dump(mode="json", exclude_none=True, exclude={"keyway"})
    return {
        key: float(value)
        for key, value in leaves(part.name, table)
        if key.endswith("_mm") and not key.endswith(HOLES) and value > 0
    }


def leaves(key: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Dotted key and value of whatever a table or list holds that is neither.

    >>> list(leaves("shaft", {"segment": [{"length_mm": 4.0}], "fillet_mm": 0.5}))
    [('shaft.segment[0].length_mm', 4.0), ('shaft.fillet_mm', 0.5)]
    """
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from leaves(f"{key}.{name}" if key else name, inner)
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from leaves(f"{key}[{i}]", inner)
    else:
        yield key, value


def without_holes(design: Design) -> Design:
    """The body of revolution that the flexspline and the shaft would be."""
    return design.model_copy(update={p.name: p.without_holes().shape for p in design.parts})


def location_of(key: str) -> Location:
    """``shaft.segment[1].length_mm``, or ``shaft.segment.1.length_mm``, part by part.

    >>> location_of("shaft.segment[1].length_mm")
    ('shaft', 'segment', 1, 'length_mm')
    """
    names = IN_BRACKETS.sub(r".\1", key).split(".")
    return tuple(int(name) if PLACE.fullmatch(name) else name for name in names)


def _reach(tables: dict[str, Any], key: str, value: object = None) -> tuple[dict[str, Any], str]:
    """The table that holds a key, and the key's last name; `value`: what it shall hold, for the error."""
    *path, last = location_of(key)
    table: Any = tables
    for depth, part in enumerate(path, 1):
        if tuple(path[:depth]) in WITH_DEFAULTS:
            table = table.setdefault(part, {})
            continue
        try:
            table = table[part]
        except (KeyError, IndexError, TypeError):
            raise DesignError(key, value, "no such key in the design file") from None
    if not (isinstance(table, dict) and isinstance(last, str)):
        raise DesignError(key, value, "no such key in the design file")
    return table, last
