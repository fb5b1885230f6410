"""The answer as a person reads it in a terminal."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from results.quantities import QUANTITIES


def table(record: dict[str, Any], folder: Path) -> str:
    """One line per figure of the record that stands in the table of quantities."""
    lines = [f"{record['design']}"]
    for entry in QUANTITIES:
        value: Any = record
        for key in entry.key.split("."):
            value = value.get(key) if isinstance(value, dict) else None
        if value is None or entry.key in ("design", "version"):
            continue
        if entry.kind == "text":
            shown = str(value)
        elif entry.kind == "bounds":
            shown = f"{entry.range_text(*value)} {entry.unit}"
        else:
            shown = f"{entry.text(value)} {entry.unit}"
        lines.append(f"  {entry.name:<64} {shown}".rstrip())
    lines.append(f"files in {folder}")
    return "\n".join(lines)
