"""Fenced blocks of the documents: what is shown as a command, what as its output, what as a file.

    ```console          commands after "$ ", their output under them; "..." stands for lines left out
    ```sh               commands, a line each
    ```toml title="x"   a file that the commands below it read

`<!-- long: why -->` before a block: run by `pytest -m long` only.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

TOLERANCE = 0.01
"""Relative. A part with a keyway is meshed again each time, K then differs by up to tolerance_pct (0.5 %)
each way, and a figure printed with three digits by up to 0.5 % more."""

FENCE = re.compile(
    r"(?:<!-- (?P<mark>long): (?P<why>[^\n]*?) -->\n+)?"
    r"^```(?P<kind>\w+)(?: title=\"(?P<file>[^\"]+)\")?\n(?P<body>.*?)^```$",
    re.S | re.M,
)
NUMBER = re.compile(r"[−-]?\d+(?: \d{3})*(?:\.\d+)?")
SPACES = re.compile(r"\s+")  # narrow ones between digits and units too


@dataclass(frozen=True)
class Command:
    """A command line and the lines shown under it."""

    line: str
    shown: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Block:
    """One fenced block of a page."""

    kind: str
    body: str
    file: str | None
    long: bool

    @property
    def commands(self) -> list[Command]:
        if self.kind == "sh":
            return [Command(line) for line in self.body.splitlines() if line.strip()]
        found: list[Command] = []
        if self.kind == "console":
            for line in self.body.splitlines():
                if line.startswith("$ "):
                    found.append(Command(line[2:]))
                elif line.strip():
                    found[-1].shown.append(line)
        return found


def blocks(page: Path) -> Iterator[Block]:
    """Every fenced block that is run or written, in order."""
    for m in FENCE.finditer(page.read_text(encoding="utf-8")):
        yield Block(m["kind"], m["body"], m["file"], m["mark"] == "long")


def missing(shown: list[str], said: list[str]) -> str | None:
    """The first shown line that the output does not have, in this order; None if it has all.

    Without "..." between them, lines shown one under the other stand so in the output.
    """
    at, free = 0, True
    for line in shown:
        if line.strip() == "...":
            free = True
            continue
        ends = range(at, len(said)) if free else range(at, min(at + 1, len(said)))
        hit = next((i for i in ends if alike(line, said[i])), None)
        if hit is None:
            return line
        at, free = hit + 1, False
    return None


def alike(shown: str, said: str) -> bool:
    """Same words, and numbers that agree within TOLERANCE or the last digit shown."""
    shown, said = (SPACES.sub(" ", s).strip() for s in (shown, said))
    if NUMBER.sub("#", shown) != NUMBER.sub("#", said):
        return False
    return all(map(_close, NUMBER.findall(shown), NUMBER.findall(said)))


def _close(shown: str, said: str) -> bool:
    a, b = (float(s.replace(" ", "").replace("−", "-")) for s in (shown, said))
    last_digit = 10.0 ** -len(shown.partition(".")[2])
    return abs(a - b) <= max(TOLERANCE * abs(a), last_digit if "." in shown else 0.0)
