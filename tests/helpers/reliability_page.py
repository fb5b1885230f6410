"""The text of docs/reliability.md: what was tried, how often, what came of it, under fixed topics."""

from __future__ import annotations

import os
import platform
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

FAULTS_FILE = Path(__file__).with_name("faults.md")
TOPICS = {
    "Designs": ("test_designs",),
    "Files": ("test_files",),
    "Crashes": (
        "test_kills", "test_full_disk", "test_damaged_cache", "test_broken_mesher", "test_temporary_files",
    ),
    "Size": ("test_size",),
    "Numbers": ("test_numbers",),
}  # fmt: skip
"""Headings in the page's order, and the test modules that hand in their rows."""
HEAD = """\
# Reliability

Written by `python3 -m pytest tests/reliability -m "long or not long" --write-reliability` from what the
tests did; edit the tests, not this page. A row is replaced when its test has run and passed, so the parts
can be run one by one. *Answered*: status 0 and finite figures between their bounds. *Refused*: status 2,
one line, nothing written. *Failed*: status 1 with its reason in one line. A traceback, a hang, or a
half-written file fails the test. Long tests come in blocks, a row each; a block without a row has not run
since it was written. Times are by the clock
on a busy machine: several other processes for each core.
"""
COLUMNS = "| tried | how many | what came of it | longest |\n|---|---|---|---|"
NAMES_ORDER = ("answered", "refused", "failed")


@dataclass(frozen=True)
class Fact:
    """One row: `tried` and `outcome` in words, how many, and the longest in seconds."""

    module: str
    tried: str
    count: int
    outcome: str
    longest_s: float | None = None

    def line(self) -> str:
        s = self.longest_s
        longest = "" if s is None else f"{s:.0f} s" if s >= 100 else f"{s:.3g} s"
        return f"| {self.tried} | {self.count} | {self.outcome} | {longest} |"


def counted(outcomes: Counter[str]) -> str:
    """``12 answered, 88 refused``."""
    return ", ".join(f"{outcomes[name]} {name}" for name in NAMES_ORDER if outcomes[name]) or "none"


def section(topic: str, kept: Sequence[str], facts: Sequence[Fact]) -> str:
    """A topic's heading, files and table: rows `kept` from the page, those of `facts` renewed."""
    modules = TOPICS[topic]
    files = ", ".join(f"[`{m}`](../tests/reliability/{m}.py)" for m in modules)
    renewed = {_tried(row): row for row in kept}
    renewed |= {f.tried: f.line() for m in modules for f in facts if f.module == m}
    rows = [renewed[tried] for tried in sorted(renewed, key=_natural)]
    python = ".".join(platform.python_version_tuple()[:2])
    machine = f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores, Python {python}"
    return f"## {topic}\n\n{files}; {machine}.\n\n" + "\n".join([COLUMNS, *rows]) + "\n"


def rows_of(page: str) -> dict[str, list[str]]:
    """Rows of the tables of a page, by heading."""
    parts = page.split("\n## ")[1:]
    lines = {p.partition("\n")[0]: p.splitlines() for p in parts}
    return {
        name: [s for s in all_ if s[:2] == "| " and s not in COLUMNS]
        for name, all_ in lines.items()
    }


def _tried(row: str) -> str:
    return row.split(" | ")[0].removeprefix("| ")


def _natural(text: str) -> list[tuple[int, str]]:
    """Numbers by their size."""
    return [(int(s), "") if s.isdigit() else (-1, s) for s in re.split(r"(\d+)", text)]


def page(before: str, facts: Sequence[Fact]) -> str:
    """The page with the rows of these facts renewed and the others kept."""
    kept = rows_of(before)
    known = {f.module for f in facts}
    body = [
        section(topic, kept.get(topic, []), facts)
        for topic, modules in TOPICS.items()
        if topic in kept or known & set(modules)
    ]
    return "\n".join([HEAD, *body, FAULTS_FILE.read_text(encoding="utf-8")])
