"""Writes the tables of docs/whole-gear.md; its words are written by hand. About a minute.

python3 docs/make_whole_gear.py
"""

from __future__ import annotations

import re
from pathlib import Path

import whole_gear_contact_3d as contact_3d
import whole_gear_figures as figures
import whole_gear_ratcheting as ratcheting
import whole_gear_wall as wall

from flexspline.fea.threads import one_thread
from flexspline.geometry.percent import percent

PAGE = Path(__file__).with_name("whole-gear.md")
MARK = "<!-- made by docs/make_whole_gear.py: {} -->\n"
SIZE, TORQUES = 25, (14.0, 48.0, 96.0)
"""Of the sensitivities: a size in the middle, with its T1, T2 and twice T2 [N·m]."""
AIM_K3, AIM_RATIO = 0.30, 0.25
"""What K3, and K3/K1, were hoped to be within, in three rows of four."""


def tables() -> dict[str, str]:
    """What stands below each mark."""
    found = list(figures.rows())
    of_examples, terms = figures.examples()
    return {
        "examples": of_examples,
        "terms": terms,
        "published cup": figures.published_table(),
        **three_dimensional(),
        "classes": figures.by_class(found),
        "aims": aims(found),
        "rows": figures.catalogue_table(found),
        "ratio 100": figures.sensitivity(SIZE, 100, TORQUES),
        "ratio 30": figures.sensitivity(SIZE, 30, TORQUES),
        "wall": wall.catalogue_table(),
        "tube": wall.calculix_table(),
        "ratcheting": ratcheting.by_ratio(),
        "ratcheting rows": ratcheting.each(),
        "ratcheting sensitivity": ratcheting.sensitivity(SIZE),
    }


def three_dimensional() -> dict[str, str]:
    """The tables that stand beside recorded contact solutions of other programs."""
    found = contact_3d.record()
    return {
        "three-dimensional curves": contact_3d.curves_table(found),
        "three-dimensional meshes": contact_3d.meshes_table(found),
        "three-dimensional surface contact": contact_3d.surface_table(found),
        "three-dimensional assumptions": contact_3d.assumptions_table(found),
        "meshed teeth": contact_3d.teeth_table(),
    }


def aims(found: list[figures.Row]) -> str:
    """In how many rows the aims are met."""
    lines = []
    for words, index, aim in (("K3", 2, AIM_K3), ("K3/K1", 3, AIM_RATIO)):
        alone, with_shaft = (figures.within(found, index, aim, shaft) for shaft in (False, True))
        lines.append(f"| {words} within ± {percent(aim)} | {alone} | {with_shaft} |")
    return "\n".join(lines)


def written(text: str, made: dict[str, str]) -> str:
    """The page with these tables: a header's two lines stay, the rows below them are new."""
    for name, rows in made.items():
        mark = re.escape(MARK.format(name))
        block = re.compile(rf"({mark}\n\|[^\n]*\n\|[-|]*\n)(?:\|[^\n]*\n)*")
        text, count = block.subn(lambda m, rows=rows: f"{m[1]}{rows}\n", text)
        if count != 1:
            raise ValueError(f"{PAGE.name} has {count} tables marked {name!r}")
    return text


if __name__ == "__main__":
    with one_thread():  # matrices are small: threads wait for each other
        PAGE.write_text(written(PAGE.read_text(encoding="utf-8"), tables()), encoding="utf-8")
