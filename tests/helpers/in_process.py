"""The command inside this process, as its users' shell would see it: status, streams, files."""

from __future__ import annotations

import re
import time
import unicodedata
from dataclasses import dataclass
from pathlib import Path

from typer.testing import CliRunner

from flexspline.results.cli import app

STATUS = {0: "answered", 1: "failed", 2: "refused"}
SCRATCH = (".part", ".export-", ".tmp")
"""How files that are still being written are called."""
PROGRESS = re.compile(
    r"\[ *[0-9.]+ s\] |warning: |discarded |\d+ of \d+ designs|\d+ designs are finished"
)
"""How lines begin that tell how far the work is, or what is unusual."""


@dataclass(frozen=True)
class Ended:
    """How a command ended."""

    status: int
    stdout: str
    stderr: str
    seconds: float
    written: frozenset[str]
    """Paths below the watched folder that were not there before."""

    @property
    def word(self) -> str:
        return STATUS[self.status]

    @property
    def said(self) -> list[str]:
        """Lines on stderr that are neither progress nor a warning."""
        return [s for s in self.stderr.split("\n") if s and not PROGRESS.match(s)]


def flexspline(*words: object, folder: Path) -> Ended:
    """Run a command; an error that is no exit status is raised here as it was there.

    Raises
    ------
    AssertionError : half-written files remain, a control character reached the terminal, or a refusal
        or failure is not one line that begins with the program's name.
    """
    before = _tree(folder)
    began = time.perf_counter()
    done = CliRunner().invoke(app, [str(w) for w in words])
    seconds = time.perf_counter() - began
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    ended = Ended(done.exit_code, done.stdout, done.stderr, seconds, _tree(folder) - before)
    assert ended.status in STATUS, ended
    check_streams(ended)
    assert not [p for p in ended.written if any(s in p for s in SCRATCH)], ended.written
    if ended.status == 2:
        assert not ended.written, ended
    return ended


def check_streams(ended: Ended) -> None:
    """One line where something is wrong, nothing on stdout then, and no control characters anywhere."""
    for stream in (ended.stdout, ended.stderr):
        assert not [
            c for c in stream if c != "\n" and unicodedata.category(c) in ("Cc", "Zl", "Zp")
        ]
    assert "Traceback" not in ended.stderr
    if ended.status:
        assert ended.stdout == "", ended
        assert len(ended.said) == 1, ended
        assert ended.said[0].startswith("flexspline: "), ended


def _tree(folder: Path) -> frozenset[str]:
    return frozenset(str(p.relative_to(folder)) for p in folder.rglob("*"))
