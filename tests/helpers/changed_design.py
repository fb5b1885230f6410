"""Small changes to the text of an example design, key by key, as a user's slip would make them."""

from __future__ import annotations

import re
import tomllib

from example_files import EXAMPLES

from flexspline.geometry.design import Design
from flexspline.geometry.load import design_from


def changed_text(example: str, changes: dict[str, str | None]) -> str:
    """The example's text with dotted keys set to the given TOML text, or removed where None."""
    text = (EXAMPLES / f"{example}.toml").read_text(encoding="utf-8")
    for dotted, value in changes.items():
        text = _changed(text, dotted, value)
    return text


def changed_design(example: str, changes: dict[str, str | None]) -> Design:
    """The same, loaded and checked."""
    return design_from(tomllib.loads(changed_text(example, changes)))


def _changed(text: str, dotted: str, value: str | None) -> str:
    table, _, key = dotted.rpartition(".")
    indexed = re.fullmatch(r"(.*)\[(\d+)\]", table)
    name, count = (indexed[1], int(indexed[2])) if indexed else (table, 0)
    header = f"[[{name}]]" if indexed else f"[{name}]"
    blocks = re.split(r"(?m)^(?=\[)", text)  # the text before the first table, then each table
    found = [i for i, b in enumerate(blocks) if b.startswith(header)] if table else [0]
    if not found:
        return text + f"\n{header}\n{key} = {value}\n"
    i = found[count]
    lines = [x for x in blocks[i].splitlines() if not re.match(rf"{re.escape(key)}\s*=", x)]
    if value is not None:
        lines.append(f"{key} = {value}")
    blocks[i] = "\n".join(lines) + "\n"
    return "".join(blocks)


def shaft_of(
    segments: list[tuple[float, float, float]], settings: str = "", fillet: float = 0.5
) -> Design:
    """A shaft of (length, outer, inner) segments gripped over 5 mm, on the hole-free cup."""
    data = tomllib.loads((EXAMPLES / "keyed-shaft.toml").read_text(encoding="utf-8"))
    data["shaft"] = {"fillet_mm": fillet, "grip_length_mm": 5.0} | tomllib.loads(settings)
    data["shaft"]["segment"] = [
        {"length_mm": length, "outer_diameter_mm": outer, "inner_diameter_mm": inner}
        for length, outer, inner in segments
    ]
    return design_from(data)
