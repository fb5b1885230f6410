"""Mutated files of every kind that is read: refused in one line, or still good and answered."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import pytest
from bases import KINDS, SUFFIX, base, hands, words
from in_process import flexspline
from mutations import MUTATIONS, mutated
from reliability_page import counted

LONGEST_S = 30.0
"""Of one file: the good ones take up to a second; megabytes of one line are read, not pondered."""
STRUCTURAL = ("truncation", "deep nesting, long lines and keys")


@dataclass(frozen=True)
class Tried:
    """A mutated file's number, kind and mutation, what came of it, and the reason."""

    seed: int
    kind: str
    mutation: str
    word: str
    seconds: float
    reason: str


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, where an injected path or command would leave its trace."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(tmp_path.parent / f"{tmp_path.name}-cache"))
    monkeypatch.setattr("pipeline.study.cluster.dask_hands", hands)
    return tmp_path


def tried(seed: int, sources: Path, folder: Path) -> Tried:
    """Give mutated file number `seed` to the command that reads its kind."""
    kind = KINDS[seed // len(MUTATIONS) % len(KINDS)]
    mutation, data = mutated(base(kind, sources), seed)
    path = folder / f"{seed}.{SUFFIX.get(kind, 'csv')}"
    path.write_bytes(data)
    torque = folder / "torque.csv"
    torque.write_bytes(b"torque_Nm\n0.1\n0.2\n0.3\n")
    ended = flexspline(*words(kind, path, torque), "--out", folder / f"{seed}", folder=folder)
    assert not (folder / "owned").exists(), seed
    assert path.read_bytes() == data
    reason = ended.said[0] if ended.status else ""
    return Tried(seed, kind, mutation, ended.word, ended.seconds, reason)


def try_all(seeds: range, sources: Path, folder: Path) -> list[Tried]:
    found = [tried(seed, sources, folder) for seed in seeds]
    assert max(t.seconds for t in found) < LONGEST_S, max(found, key=lambda t: t.seconds)
    # a failure is what a file may ask for and not get: a database that is not there, a long study
    for t in found:
        assert t.word != "failed" or t.kind in ("study", "extended model", "design"), t
    return found


def test_ninety_six_files(here: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    found = try_all(range(96), tmp_path_factory.mktemp("sources"), here)
    words = Counter(t.word for t in found)
    assert words["refused"] > 48
    assert words["failed"] < 5


@pytest.mark.long
def test_a_thousand_files(here: Path, tmp_path_factory: pytest.TempPathFactory, fact) -> None:
    found = try_all(range(1008), tmp_path_factory.mktemp("sources"), here)
    for mutation in MUTATIONS:
        own = [t for t in found if t.mutation == mutation]
        fact(mutation, len(own), counted(Counter(t.word for t in own)), max(t.seconds for t in own))
