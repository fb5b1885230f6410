"""Writes the tables of figures in contract.md from the program's table of quantities.

python3 docs/make_record_keys.py
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from flexspline.results.gear_quantities import GEAR_QUANTITIES
from flexspline.results.quantities import QUANTITIES
from flexspline.results.quantity import Quantity

PAGE = Path(__file__).with_name("contract.md")
MARK = "<!-- written by docs/make_record_keys.py: {} -->\n"
STUDY_ONLY = ("flexspline_length_mm", "shaft_length_mm")
"""Figures that no result.json has: a study's tables do."""


def rows(quantities: Iterable[Quantity]) -> Iterator[str]:
    """A line for each: key, unit, meaning."""
    for q in quantities:
        key = f"`{q.key}`"
        if q.kind == "bounds":
            key += f", `{q.key.replace('_bounds_Nm_per_rad', '_bounds_kind')}`"
        symbol = f" ({q.symbol})" if q.symbol and q.kind != "bounds" else ""
        note = f": {q.note}" if q.note else ""
        only = "; only in the tables of a study" if q.key in STUDY_ONLY else ""
        yield f"| {key} | {q.unit or '–'} | {q.name}{symbol}{note}{only} |\n"


def tables() -> dict[str, str]:
    """Every table, by the name in its mark."""
    of_run = [q for q in QUANTITIES if q not in GEAR_QUANTITIES]
    head = "| key | unit | meaning |\n|---|---|---|\n"
    return {
        "result.json": head + "".join(rows(of_run)),
        "gear.json": head + "".join(rows(GEAR_QUANTITIES)),
    }


def written(page: str) -> str:
    """The page with its tables made again; each ends at an empty line."""
    for name, table in tables().items():
        mark = MARK.format(name)
        before, after = page.split(mark)
        page = before + mark + "\n" + table + "\n" + after.lstrip("\n").split("\n\n", 1)[1]
    return page


if __name__ == "__main__":
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
