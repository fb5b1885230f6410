"""The steps of a sweep's diagnosis name the files that they are in."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest
from source_tree import parsed

from flexspline.pipeline.diagnosis.sweep import diagnose, verdict

PACKAGE = "flexspline.pipeline.diagnosis."
TEXTS = [Path(m.__file__).read_text(encoding="utf-8") for m in (diagnose, verdict)]


def files(text: str) -> dict[str, str]:
    """Functions that a file imports from the diagnosis, each with its file, as seen from `sweep/`."""
    found = {}
    for node in parsed(text).body:
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(PACKAGE):
            path = str(node.module).removeprefix(PACKAGE).replace(".", "/") + ".py"
            path = path.removeprefix("sweep/") if path.startswith("sweep/") else f"../{path}"
            found |= {alias.name: path for alias in node.names if alias.name.islower()}
    return found


def unlike(text: str) -> Iterator[str]:
    """Lines that call such a function and name no file or another one, and those that name one in vain."""
    file_of, lines = files(text), text.splitlines()
    said = {
        i: line.rpartition("  # ")[2] for i, line in enumerate(lines, 1) if line.endswith(".py")
    }
    for node in ast.walk(parsed(text)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            wanted = file_of.get(node.func.id)
            if wanted is not None and said.pop(node.lineno, None) != wanted:
                yield lines[node.lineno - 1]
    yield from said.values()


@pytest.mark.parametrize("text", TEXTS, ids=["diagnose", "verdict"])
def test_each_step_names_its_file(text: str) -> None:
    assert list(unlike(text)) == []


def test_the_check_sees_a_step_that_moved() -> None:
    imported = f"from {PACKAGE}sweep.race import run_race\n"
    assert list(unlike(imported + "a = run_race(b)  # race.py\n")) == []
    moved = ["a = run_race(b)  # search.py", "a = run_race(b)"]
    for line in moved:
        assert list(unlike(f"{imported}{line}\n")) == [line]
    assert list(unlike("a = 1  # race.py\n")) == ["race.py"]
