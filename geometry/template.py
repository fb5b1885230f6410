"""Designs as TOML with the schema's descriptions as comments: a first design, or any other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from flexspline.geometry.design import Design
from flexspline.geometry.first_values import first_values
from flexspline.geometry.schema import Location, allowed, json_schema, node_at
from flexspline.geometry.shapes import SHAPES
from flexspline.geometry.toml_text import TomlTable, quoted

__all__ = ["design_text", "json_schema", "template"]

OPTIONAL: frozenset[Location] = frozenset(
    {
        ("shaft", "keyway"),
        ("material", "shaft"),
        ("material", "circular_spline"),
        ("material", "bearing"),
        ("gear", "rated_torque_Nm"),
        ("gear", "working_depth_mm"),
        ("gear", "circular_spline_diameter_mm"),
        ("wave_generator",),
        ("solver", "edge_length_mm"),
    }
)
"""Written as comments: their absence means something."""

OVERSTRESSED = "On the wave generator its peak stress is above the fatigue limit (`flexspline run`)"
NO_REASONS: Mapping[Location, str] = {}


def template(kind: str = "cup") -> str:
    """Text of a design file that loads as it stands, every key with its meaning and unit.

    Raises
    ------
    DesignError : no such kind.
    """
    title = f"# A strain wave gear with a {kind}. Keys carry their units; unknown keys are refused."
    values = first_values(kind)
    first = SHAPES[kind].first
    if first.overstressed:
        title += f"\n# {OVERSTRESSED}.\n# {first.lowers_stress}."
    return text_of(title, values, kind, {})


def text_of(
    title: str,
    values: TomlTable,
    kind: str,
    why: Mapping[Location, str],
    stated: frozenset[Location] = frozenset(),
) -> str:
    """Text of a design file with these tables, every key with its meaning and why it has its value.

    `stated`: optional keys that are no comment.
    """
    lines = [title, *_lines((), values, kind, OPTIONAL - stated, optional=False, why=why)]
    return "\n".join(lines) + "\n"


def design_text(design: Design) -> str:
    """Text of a design file that loads as exactly this design, every key with its meaning."""
    values = design.tables
    lines = _lines((), values, design.flexspline.kind, frozenset(), optional=False)
    return "\n".join(lines) + "\n"


def _lines(
    location: Location,
    table: TomlTable,
    kind: str,
    hidden: frozenset[Location],
    optional: bool,
    why: Mapping[Location, str] = NO_REASONS,
) -> Iterator[str]:
    """The table's own keys, then the tables below it, as TOML wants them; `hidden` as comments."""
    for key, value in table.items():
        if not isinstance(value, dict | list):
            comment = "# " if optional or (*location, key) in hidden else ""
            setting = f"{comment}{key} = {_toml(value)}"
            reason = why.get((*location, key))
            assumed = f"; assumed: {reason}" if reason else ""
            yield f"{setting:<36} # {_meaning((*location, key), kind)}{assumed}"
    for key, value in table.items():
        below = (*location, key)
        comment = "# " if optional or below in hidden else ""
        name = ".".join(str(part) for part in below)
        if isinstance(value, dict):
            if any(not isinstance(v, dict) for v in value.values()):  # [material] holds tables only
                yield ""
                yield f"{comment + f'[{name}]':<36} # {_about(below, kind)}"
            yield from _lines(below, value, kind, hidden, bool(comment), why)
        elif isinstance(value, list):
            for i, item in enumerate(value):
                yield f"{comment + f'[[{name}]]':<36} # {_about((*below, i), kind)}"
                yield from _lines((*below, i), item, kind, hidden, bool(comment), why)


def _about(location: Location, kind: str) -> str:
    """First line of a table's description."""
    return node_at(location, kind).get("description", "").partition("\n")[0]


def _meaning(location: Location, kind: str) -> str:
    return node_at(location, kind).get("description") or allowed(location, kind)


def _toml(value: str | float) -> str:
    """A number that reads back as the same double, or a basic string."""
    return quoted(value) if isinstance(value, str) else repr(value)
