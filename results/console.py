"""The result as text for a terminal."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flexspline.geometry.errors import plain_number
from flexspline.pipeline.backlash import STD_KEY
from flexspline.results.doubt import NOT_STATED, stated_only
from flexspline.results.numbers import grouped
from flexspline.results.peaks import BORDER, HALF_SEAT, MEANING, WITHOUT_HOLES, marked
from flexspline.results.quantities import QUANTITIES
from flexspline.results.streams import files_in
from flexspline.results.terminal import prose, row

NAMES = 64
"""Width of the column of names."""
NO_NOTES: Mapping[str, str] = {}


def table(record: dict[str, Any], folder: Path, notes: Mapping[str, str] = NO_NOTES) -> str:
    """One line per figure of the record that stands in the table of quantities, then what was assumed.

    `notes` stand beside figures, by key.
    """
    lines = [f"{record['design']}"]
    at_border = False
    gear = record.get("gear", {})  # a run's; `flexspline gear` has its figures beside the others
    for entry in QUANTITIES:
        value: Any = {**gear, **record}
        for key in entry.key.split("."):
            value = value.get(key) if isinstance(value, dict) else None
        if value is None and entry.key == STD_KEY and "backlash_arcsec" in record:
            lines += row((entry.name, NOT_STATED), (NAMES,))
        if value is None or entry.key in ("design", "version"):
            continue
        if entry.kind == "text":
            shown = str(value)
        elif entry.kind == "bounds":
            kind = record.get(entry.key.replace("_bounds_Nm_per_rad", "_bounds_kind"), "")
            shown = f"{entry.range_text(*value)} {entry.unit}" + (f", {kind}" if kind else "")
        else:
            border = marked(record, entry.key)
            at_border |= bool(border)
            mark = border or notes.get(entry.key)
            if entry.key == HALF_SEAT and WITHOUT_HOLES in record:
                whole = f"without bolt holes; {entry.with_unit(record[WITHOUT_HOLES])} on the whole seat"
                mark = "; ".join(filter(None, (whole, mark)))
            shown = f"{entry.text(value)} {entry.unit}" + (f", {mark}" if mark else "")
            if entry.key == STD_KEY:
                shown += stated_only(record.get("backlash_std_by_source_arcsec", {}))
        lines += row((entry.name, shown), (NAMES,))
    if at_border:
        lines += prose(f"“{BORDER}”: {MEANING}")
    if terms := record.get("terms_arcsec"):
        from flexspline.results.gear_terms import term_names

        torque = f"{record['terms_torque_Nm']:g} N·m (load.torque_Nm)"
        lines += row((f"Twist between ± {torque}, term by term:",))
        for term, name in term_names().items():
            lines += row((name, f"{grouped(terms[term], 1)} arcsec"), (NAMES - 2,), "    ")
    if "assumed" in gear:
        keys = ", ".join(a["key"] for a in gear["assumed"])
        lines += row((f"assumed for the whole gear: {keys}",))
    for a in record.get("assumed", ()):
        lines += row((f"assumed: {a['key']} = {plain_number(a['value'], 4)}, {a['why']}",))
    lines.append(files_in(folder))
    return "\n".join(lines)
