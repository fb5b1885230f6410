"""Writes the drawings in architecture.md from the imports of the code.

python3 docs/make_architecture.py
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "architecture.md"
ROOMS = ("geometry", "fea", "pipeline", "results")
SWEEP = "pipeline.diagnosis.sweep"
"""The one package with folders of its own at the fourth level: it has a drawing of its own."""
MARK = "<!-- drawn by docs/make_architecture.py: {} -->\n"


def modules(room: str) -> Iterator[tuple[tuple[str, ...], Path]]:
    """Dotted name, in parts, and file of every module of a room."""
    for path in sorted((ROOT / room).rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        yield parts[:-1] if parts[-1] == "__init__" else parts, path


def packages() -> set[tuple[str, ...]]:
    """Every folder of modules, as parts of its dotted name."""
    return {path.parent.relative_to(ROOT).parts for room in ROOMS for _, path in modules(room)}


def imported(path: Path) -> Iterator[tuple[str, ...]]:
    """Modules of ours that a file imports anywhere, less the leading `flexspline`."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("flexspline."):
            for alias in node.names:
                yield (*node.module.split(".")[1:], alias.name)


@cache
def arrows() -> set[tuple[str, str]]:
    """Which package imports from which other."""
    known, found = packages(), set[tuple[str, str]]()
    for room in ROOMS:
        for _, path in modules(room):
            here = path.parent.relative_to(ROOT).parts
            for target in imported(path):
                there = next(target[:n] for n in range(len(target), 0, -1) if target[:n] in known)
                if there != here:
                    found.add((".".join(here), ".".join(there)))
    return found


def between_rooms() -> str:
    """The four rooms, and which imports from which."""
    found = {(here.split(".")[0], there.split(".")[0]) for here, there in arrows()}
    lines = [f"  {a} --> {b}" for a, b in sorted(found) if a != b]
    return "\n".join(["```mermaid", "graph RL", *lines, "```", ""])


def within(package: str) -> str:
    """The packages in one, to two levels below it, and what each of them imports there."""
    levels = package.count(".") + 3
    folded = {tuple(".".join(n.split(".")[:levels]) for n in pair) for pair in arrows()}
    inside = [pair for pair in folded if all(f"{n}.".startswith(f"{package}.") for n in pair)]
    found = {(a, b) for a, b in inside if a != b}
    names = sorted({name for pair in found for name in pair})
    shown = [f'  {n.replace(".", "_")}["{n.removeprefix(package + ".")}"]' for n in names]
    lines = [f"  {a.replace('.', '_')} --> {b.replace('.', '_')}" for a, b in sorted(found)]
    return "\n".join(["```mermaid", "graph LR", *shown, *lines, "```", ""])


def drawings() -> dict[str, str]:
    """Every drawing of the page, by the name in its mark."""
    made = {"rooms": between_rooms()}
    return made | {name: within(name) for name in (*ROOMS[1:], SWEEP)}


def written(page: str) -> str:
    """The page with its drawings made again."""
    for name, drawing in drawings().items():
        mark = MARK.format(name)
        before, after = page.split(mark)
        page = before + mark + drawing + after.split("```\n", 1)[1]
    return page


if __name__ == "__main__":
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
