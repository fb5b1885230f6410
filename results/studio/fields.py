"""The design as a form: every key with its label, unit, limits and a slider's range.

All of it comes from the schema; the page has no list of keys of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import floor
from types import MappingProxyType
from typing import Any

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.gear_assumptions import gear_assumptions
from flexspline.geometry.load import design_from
from flexspline.geometry.ranges import is_number
from flexspline.geometry.schema import Location, SchemaNode, dotted, key_words, node_at
from flexspline.results.numbers import round_number
from flexspline.results.sentences import capital

GROUPS: tuple[tuple[str, Location], ...] = (
    ("Flexspline", ("flexspline",)),
    ("Shaft", ("shaft",)),
    ("Material of the flexspline", ("material", "flexspline")),
    ("Material of the shaft", ("material", "shaft")),
    ("Material of the circular spline", ("material", "circular_spline")),
    ("Material of races and balls", ("material", "bearing")),
    ("Gear", ("gear",)),
    ("Bearing", ("bearing",)),
    ("Wave generator", ("wave_generator",)),
    ("Load", ("load",)),
    ("Uncertainty, one standard deviation", ("uncertainty",)),
    ("Solver", ("solver",)),
)
SLIDER_SHARE = 0.5
"""A slider reaches from the nominal value less half of it to half of it more."""
SLIDER_PLACES = 200
"""A slider has at least so many places."""
MOST_HOLES = 12.0
"""Where no bolts are stated the slider goes up to as many as the first hat has."""
Tables = dict[str, Any]


def received(tables: Any) -> Design:
    """A design from what a browser sent.

    Raises
    ------
    DesignError : no tables at all, or as `design_from`.
    """
    if not isinstance(tables, dict):
        raise DesignError("the design", tables, "must be the tables of a design file")
    return design_from(tables)


def form(design: Design) -> list[Tables]:
    """The groups of the form, each a title and its entries, for the design's own kind and segments."""
    tables = design.tables
    kind, usual = design.flexspline.kind, assumed_values(design)
    groups: list[Tables] = []
    for title, location in GROUPS:
        groups += _group(title, location, _at(tables, location), kind, usual)
        if location == ("shaft",):
            for i, segment in enumerate(tables["shaft"]["segment"]):
                name = "flange" if i == 0 else f"segment {i + 1}"
                groups += _group(f"Shaft, {name}", ("shaft", "segment", i), segment, kind)
            groups += _group("Keyway", ("shaft", "keyway"), tables["shaft"].get("keyway"), kind)
    return groups


def _at(tables: Tables, location: Location) -> Tables | None:
    table: Any = tables
    for part in location:
        table = table.get(part) if isinstance(table, dict) else None
    return table


def assumed_values(design: Design) -> dict[str, float]:
    """What stands for keys of the gear that the design leaves out, by key."""
    return {assumed.key: assumed.value for assumed in gear_assumptions(design)}


def _group(
    title: str,
    location: Location,
    table: Tables | None,
    kind: str,
    usual: Mapping[str, float] = MappingProxyType({}),
) -> Iterator[Tables]:
    """Nothing for a table that the design leaves out; `usual`: where sliders of absent values stand."""
    if table is None:
        return
    scale = max((float(v) for v in table.values() if is_number(v)), default=1.0)
    entries = [
        _entry((*location, key), node_at((*location, key), kind), table.get(key), scale, usual)
        for key in node_at(location, kind).get("properties", {})
    ]
    known = [e for e in entries if e]
    yield {"title": title, "at": list(location), "entries": sorted(known, key=_after_dimensions)}


def _after_dimensions(entry: Tables) -> int:
    """Dimensions in the file's order first, then bolts, then choices; names stay in front."""
    return 2 if entry["kind"] == "choice" else int(str(entry["at"][-1]).startswith("bolt_"))


def _entry(
    location: Location, node: SchemaNode, value: Any, scale: float, usual: Mapping[str, float]
) -> Tables | None:
    """One key: a number with its slider, or a choice; None for tables and for what has no choice."""
    words, unit = key_words(str(location[-1]))
    about = {
        "key": dotted(location),
        "at": list(location),
        "label": capital(words),
        "unit": unit,
        "hint": node.get("description", ""),
    }
    if "enum" in node:
        return {**about, "kind": "choice", "options": node["enum"]}
    if node.get("type") == "string" and "const" not in node:
        return {**about, "kind": "text"}
    if node.get("type") not in ("number", "integer"):
        return None
    whole = node["type"] == "integer"
    stand_in = usual.get(dotted(location)) if value is None else value
    low, high, step = slider(node, stand_in, scale, whole, str(location[-1]))
    return {
        **about, "kind": "whole" if whole else "number", "optional": value is None,
        "low": low, "high": high, "step": step, "usual": stand_in,
    }  # fmt: skip


def slider(
    node: SchemaNode, value: float | None, scale: float, whole: bool, key: str
) -> tuple[float, float, float]:
    """Range and step about a nominal value, within the schema's limits.

    Where the value is 0 or absent the slider goes up to a tenth of the table's largest figure.
    """
    least = float(node["minimum"])
    most = float(node["maximum"])
    low, high = (
        (value * (1 - SLIDER_SHARE), value * (1 + SLIDER_SHARE)) if value else (0.0, scale / 10)
    )
    step = round_number((high - low) / SLIDER_PLACES)
    if whole:
        # teeth differ by an even number between the gears: steps of two keep it so
        step = 2.0 if key.startswith("teeth") else max(1.0, float(round(step)))
        low, high = (floor(low / step) * step, high) if value else (0.0, max(high, MOST_HOLES))
        low += (value or 0) % step
    low = max(low, least) if least > 0 else max(low, 0.0)
    return _tidy(low, step), _tidy(min(high, most), step), step


def _tidy(value: float, step: float) -> float:
    """The multiple of the step nearest to a value, without binary dust; limits stay as they are."""
    near = float(f"{round(value / step) * step:.12g}")
    return near if near > 0 or value <= 0 else value
