"""The schema as plain data: description and valid range of each dotted key, in words."""

from __future__ import annotations

from functools import cache
from typing import Any

from flexspline.geometry.design import Design
from flexspline.geometry.listed import joined
from flexspline.geometry.ranges import Range
from flexspline.geometry.shapes import KINDS, SHAPES
from flexspline.geometry.toml_text import quoted

Location = tuple[str | int, ...]
SchemaNode = dict[str, Any]

UNITS = {
    "_mm": "mm",
    "_um": "µm",
    "_GPa": "GPa",
    "_MPa": "MPa",
    "_Nm": "N·m",
    "_deg": "deg",
    "_pct": "%",
    "_kg_per_m3": "kg/m³",
}
"""Key suffix to unit."""


def key_words(key: str) -> tuple[str, str]:
    """A design key, or only its last name, in words, and its unit.

    >>> key_words("flexspline.wall_thickness_mm"), key_words("poissons_ratio")
    (('flexspline wall thickness', 'mm'), ("Poisson's ratio", ''))
    """
    suffix = next((suffix for suffix in UNITS if key.endswith(suffix)), "")
    words = key.removesuffix(suffix).replace(".", " ").replace("_", " ")
    words = words.replace("youngs", "Young's").replace("poissons", "Poisson's")
    return words, UNITS.get(suffix, "")


@cache
def json_schema() -> SchemaNode:
    """JSON Schema (2020-12) of the design file; editors complete and check with it."""
    schema = Design.model_json_schema()
    for shape in SHAPES.values():
        kind = schema["$defs"][shape.__name__]["properties"]["kind"]
        kind["description"] = joined(KINDS, "or")
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **schema,
        "title": "flexspline design file",
    }


def node_at(location: Location, kind: str | None = None) -> SchemaNode:
    """The schema of a key; `kind` says which flexspline is meant. Empty if there is no such key."""
    node = json_schema()
    for part in location:
        node = resolved(node, kind)
        if isinstance(part, int):
            node = node.get("items", {})
        else:
            node = node.get("properties", {}).get(part, {})
    return resolved(node, kind)


def resolved(node: SchemaNode, kind: str | None = None) -> SchemaNode:
    """Follow a reference, an optional value's type, or the flexspline's kind."""
    outer = {k: v for k, v in node.items() if k in ("description", "default")}
    if "$ref" in node:
        target = json_schema()["$defs"][node["$ref"].split("/")[-1]]
        return {**resolved(target, kind), **outer}
    if {"type": "null"} in node.get("anyOf", ()):
        inner = next(n for n in node["anyOf"] if n != {"type": "null"})
        return {**resolved(inner, kind), **outer}
    if "discriminator" in node:
        mapping = node["discriminator"]["mapping"]
        return resolved({"$ref": mapping[kind]}, kind) if kind in mapping else {"type": "object"}
    return node


def keys_of(location: Location, kind: str | None = None) -> list[str]:
    """Keys that a table takes."""
    return list(node_at(location, kind).get("properties", {}))


def dotted(location: Location) -> str:
    """``("shaft", "segment", 1, "width")`` → ``shaft.segment[1].width``, counted from 0."""
    text = ""
    for part in location:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            bare = part.isascii() and part.replace("_", "").replace("-", "").isalnum()
            shown = part if bare else ascii(part)
            text += ("." if text else "") + (shown if len(shown) <= 60 else shown[:59] + "…")
    return text


def allowed(location: Location, kind: str | None = None) -> str:
    """What a key may hold, in words: ``a number from 0 to 100 (%)``."""
    node = node_at(location, kind)
    if "enum" in node:
        return joined(map(quoted, node["enum"]), "or")
    if "const" in node:
        return f'"{node["const"]}"'
    if "discriminator" in node or node.get("type") == "object":
        return f"a table [{dotted(location)}]"
    if node.get("type") == "array":
        return f"{node['minItems']} to {node['maxItems']} tables [[{dotted(location)}]]"
    if node.get("type") == "string":
        return f"text of {node['minLength']} to {node['maxLength']} characters"
    noun = "a whole number" if node.get("type") == "integer" else "a number"
    return f"{noun} {_range(node)}{_unit(location)}"


def ends_of(location: Location, kind: str | None = None) -> list[float]:
    """The ends of what a number may be; whole numbers where it is one, empty where it is none."""
    node = node_at(location, kind)
    if node.get("type") not in ("number", "integer"):
        return []
    smallest = [part["minimum"] for part in node.get("anyOf", ()) if "minimum" in part]
    ends = [node["minimum"], *smallest, node["maximum"]]
    return [int(end) if node["type"] == "integer" else float(end) for end in ends]


def _range(node: SchemaNode) -> str:
    if "anyOf" not in node:
        return str(Range(node["minimum"], node["maximum"]))
    zero, rest = node["anyOf"]  # zero stands for "none"
    return f"equal to {zero['const']:g} or {Range(rest['minimum'], node['maximum'])}"


def _unit(location: Location) -> str:
    _, unit = key_words(str(location[-1]))
    return f" {unit}" if unit else ""
