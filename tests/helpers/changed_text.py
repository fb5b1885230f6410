"""Small changes to the text of an example design, key by key, as a user's slip would make them."""

from __future__ import annotations

import re

from example_files import EXAMPLES


def changed_text(example: str, changes: dict[str, str | None]) -> str:
    """The example's text with dotted keys set to the given TOML text, or removed where None."""
    text = (EXAMPLES / f"{example}.toml").read_text(encoding="utf-8")
    for dotted, value in changes.items():
        text = _changed(text, dotted, value)
    return text


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
