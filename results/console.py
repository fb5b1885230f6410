"""The answer as a person reads it in a terminal."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from flexspline.results.doubt import NOT_STATED
from flexspline.results.numbers import grouped
from flexspline.results.peaks import marked
from flexspline.results.quantities import QUANTITIES

STD_KEY = "backlash_arcsec.std"


def table(record: dict[str, Any], folder: Path) -> str:
    """One line per figure of the record that stands in the table of quantities, then what was assumed."""
    lines = [f"{record['design']}"]
    gear = record.get("gear", {})  # a run's; `flexspline gear` has its figures beside the others
    for entry in QUANTITIES:
        value: Any = {**gear, **record}
        for key in entry.key.split("."):
            value = value.get(key) if isinstance(value, dict) else None
        if value is None and entry.key == STD_KEY and "backlash_arcsec" in record:
            lines.append(f"  {entry.name:<64} {NOT_STATED}")
        if value is None or entry.key in ("design", "version"):
            continue
        if entry.kind == "text":
            shown = str(value)
        elif entry.kind == "bounds":
            kind = record.get(entry.key.replace("_bounds_Nm_per_rad", "_bounds_kind"), "")
            shown = f"{entry.range_text(*value)} {entry.unit}" + (f", {kind}" if kind else "")
        else:
            mark = marked(record, entry.key)
            shown = f"{entry.text(value)} {entry.unit}" + (f", {mark}" if mark else "")
        lines.append(f"  {entry.name:<64} {shown}".rstrip())
    if terms := record.get("terms_arcsec"):
        from flexspline.results.gear_terms import term_names

        lines.append(
            f"  Twist between ± {record['terms_torque_Nm']:g} N·m (load.torque_Nm), term by term:"
        )
        for term, name in term_names().items():
            lines.append(f"    {name:<62} {grouped(terms[term], 1)} arcsec")
    if "assumed" in gear:
        keys = ", ".join(a["key"] for a in gear["assumed"])
        lines.append(f"  assumed for the whole gear: {keys}")
    lines += [
        f"  assumed: {a['key']} = {a['value']:.4g}, {a['why']}" for a in record.get("assumed", ())
    ]
    lines.append(f"files in {folder}")
    return "\n".join(lines)
