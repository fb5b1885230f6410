"""A whole run of an example, made once and read by many tests, on whichever worker they are."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

from example_files import EXAMPLES
from shell import run

PATIENCE_S = 1800
"""Longer than any run takes on a loaded machine."""


@dataclass(frozen=True)
class FinishedRun:
    """Of `flexspline run --json`. Nothing in its folders may be changed."""

    design: Path
    folder: Path
    """What it wrote."""
    cache: Path
    """Other commands use it and add to it."""
    stderr: str
    result: dict
    """As printed."""


def finished_run(example: str, suite: Path, cache: Path) -> FinishedRun:
    """The run of an example; `suite` is the folder of this run of the suite, `cache` its cache.

    Raises
    ------
    AssertionError : the run failed, with what it said.
    """
    here, design = suite / example, EXAMPLES / f"{example}.toml"
    out = here / "out"
    stdout, stderr = _said_once(here, cache, "run", design, "--out", out, "--json")
    return FinishedRun(design, out, cache, stderr, json.loads(stdout))


@dataclass(frozen=True)
class FinishedDiagnosis:
    """Of `flexspline diagnose` in words. Nothing in its folder may be changed."""

    folder: Path
    """What it wrote."""
    stdout: str


def finished_diagnosis(suite: Path, cache: Path) -> FinishedDiagnosis:
    """The diagnosis of the example's sweep, K_b and K_e given.

    Raises
    ------
    AssertionError : it failed, with what it said.
    """
    here, design = suite / "diagnosed", EXAMPLES / "xb1-40.toml"
    out, record = here / "out", EXAMPLES / "measured" / "xb1-40-sweep.csv"
    given = ("--Kb", 31329, "--Ke", 43339)
    stdout, _ = _said_once(here, cache, "diagnose", design, record, *given, "--out", out)
    return FinishedDiagnosis(out, stdout)


def _said_once(here: Path, cache: Path, *words: object) -> tuple[str, str]:
    """What a command, run by the first who asks, said on stdout and stderr."""
    said = here / "said.json"
    here.mkdir(exist_ok=True)
    with one_at_a_time(here / "lock"):
        if not said.exists():
            done = run(*words, cache=cache, timeout_s=PATIENCE_S)
            assert done.returncode == 0, done.stderr
            said.write_text(json.dumps([done.stdout, done.stderr]), encoding="utf-8")
    stdout, stderr = json.loads(said.read_text(encoding="utf-8"))
    return stdout, stderr


@contextmanager
def one_at_a_time(path: Path) -> Iterator[None]:
    """SQLite's lock on a file: on every system, and free again when its holder dies."""
    with closing(sqlite3.connect(path, timeout=PATIENCE_S, isolation_level=None)) as database:
        database.execute("BEGIN EXCLUSIVE")
        yield
