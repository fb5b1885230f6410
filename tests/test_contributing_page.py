"""The page for contributors names files that exist, and symbols that their files define."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from source_tree import parsed

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "CONTRIBUTING.md").read_text(encoding="utf-8")
STEPS = [
    item
    for section in PAGE.split("\n## ")
    if section.startswith("Add a")
    for item in re.split(r"\n\n|\n(?=\d\. )", section)
    if "`" in item
]
"""The numbered items and the paragraphs of "Add a part", "Add a load case" and so on."""
CODE = re.compile(r"`([^`]+)`")
SYMBOL = re.compile(r"([A-Za-z_]\w*)(\(.*\))?")
NOT_SYMBOLS = frozenset({"mount", "mesh", "seat", "init", "write_NAME"})
"""Patches of the parts, a command, and a name that the contributor gives."""


def defined(file: Path) -> set[str]:
    """All classes, functions and variables that a file defines, at any depth."""
    nodes = list(ast.walk(parsed(file.read_text(encoding="utf-8"))))
    names = {n.name for n in nodes if isinstance(n, ast.ClassDef | ast.FunctionDef)}
    return names | {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}


def test_every_file_that_the_page_names_exists() -> None:
    names = [
        name
        for name in CODE.findall(re.sub(r"```.*?```", "", PAGE, flags=re.DOTALL))
        if re.fullmatch(r"[\w./-]+(\.\w+|/)", name) and "/" in name and "NAME" not in name
    ]
    assert names
    for name in names:
        assert (ROOT / name).exists() or name == "dist/site/", name


@pytest.mark.parametrize("step", STEPS, ids=lambda s: " ".join(s.split()[:5]))
def test_every_symbol_of_a_step_is_defined_in_a_file_that_the_step_names(step: str) -> None:
    words = CODE.findall(step)
    files = [ROOT / w for w in words if w.endswith(".py") and "NAME" not in w]
    known = set().union(*map(defined, files)) | NOT_SYMBOLS
    symbols = {m[1] for w in words if (m := SYMBOL.fullmatch(w))}
    assert symbols <= known, symbols - known


def test_the_check_reads_the_steps() -> None:
    named = {m[1] for step in STEPS for w in CODE.findall(step) if (m := SYMBOL.fullmatch(w))}
    assert {"RimCase", "CASES", "PEAK_OF", "CHARTS_OF", "WRITERS"} <= named
