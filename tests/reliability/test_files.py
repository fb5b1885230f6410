"""Mutated files of every kind that is read: refused in one line, or still good and answered."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pytest
from bases import KINDS, SUFFIX, base, pool, words
from in_process import flexspline
from mutations import MUTATIONS, mutated
from reliability_page import counted

HANG_S = 300.0
"""Files that stay good take up to 15 s each on a machine at rest, refused ones less than one."""
FILES = 1008
"""126 of each mutation, 21 of each with each kind of file."""


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
    """The working folder, where an injected path or command would leave its trace.

    The cache is the suite's: it holds what FE says of the specimens that stay good.
    """
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("flexspline.pipeline.study.cluster.worker_pool", pool)
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


def try_all(seeds: Iterable[int], sources: Path, folder: Path) -> list[Tried]:
    found = [tried(seed, sources, folder) for seed in seeds]
    assert max(t.seconds for t in found) < HANG_S, max(found, key=lambda t: t.seconds)
    # a failure is what a file may ask for and not get: a database that is not there, a long study
    assert {t.kind for t in found if t.word == "failed"} <= {"study"}, found
    return found


@pytest.mark.usefixtures("no_diagnosis_drawn")  # drawn too: the thousand
def test_six_files(here: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Each kind with a mutation, by turns."""
    pairs = [(kind, number) for kind in range(len(KINDS)) for number in range(len(MUTATIONS))]
    seeds = [k * len(MUTATIONS) + n for k, n in pairs if (k + n) % 8 == 0]
    found = try_all(seeds, tmp_path_factory.mktemp("sources"), here)
    words = Counter(t.word for t in found)
    assert len(found) == 6
    assert words["refused"] > 2
    assert words["failed"] < 2


@pytest.mark.long
@pytest.mark.parametrize("number", range(len(MUTATIONS)))
def test_a_thousand_files(
    number: int, here: Path, tmp_path_factory: pytest.TempPathFactory, fact
) -> None:
    seeds = range(number, FILES, len(MUTATIONS))
    found = try_all(seeds, tmp_path_factory.mktemp("sources"), here)
    outcome = counted(Counter(t.word for t in found))
    fact(found[0].mutation, len(found), outcome, max(t.seconds for t in found))
