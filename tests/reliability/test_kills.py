"""kill -9 at random moments: the same command then gives the right answer and says what it discarded."""

from __future__ import annotations

import json
import subprocess
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import bases
import numpy as np
import psutil
import pytest
from shell import command, environment, run

from flexspline.pipeline.temporary_files import MARK

GONE_WITHIN_S = 20.0
"""Children notice at once that their parent is gone, but may be in the middle of a library's call."""
SAME = 1e-9
"""Relative: the kept mesh is the same, sums of threads may take another order."""
KILLS = 5
"""In a round; ten rounds."""
LATEST = 0.97
"""Of the time of a whole run: later ones find a program that has ended."""


@dataclass(frozen=True)
class Job:
    """A command, and the file that holds its answer."""

    words: tuple[object, ...]
    answer: str


def jobs(folder: Path) -> dict[str, Job]:
    """The three commands, of one small design and file each, and the shortest of all."""
    plain, study = bases.plain(folder), folder / "study.toml"
    study.write_text(bases.study(folder).replace("evaluations = 4", "evaluations = 12"))
    sweep = folder / "sweep.csv"
    sweep.write_bytes(bases.head("xb1-40-sweep"))
    return {
        "run": Job(("run", bases.CUP), "result.json"),
        "study": Job(("study", study), "study.csv"),
        "diagnose": Job(("diagnose", plain, sweep), "diagnosis.json"),
        "backlash": Job(("backlash", plain, *bases.GIVEN), "result.json"),
    }


def answer(path: Path) -> object:
    """The file's figures, without seconds and places."""
    if path.suffix == ".csv":
        rows = [line.split(",") for line in path.read_text(encoding="utf-8").splitlines()]
        keep = [i for i, name in enumerate(rows[0]) if not name.endswith("_s")]
        return [[row[i] for i in keep] for row in rows]
    record = json.loads(path.read_text(encoding="utf-8"))
    for key in ("wall_s", "stage_s"):
        record.get("solver", {}).pop(key, None)
    record.pop("stage_s", None)
    return record


def same(a: object, b: object, where: str = "") -> None:
    """Equal, numbers within `SAME`."""
    if isinstance(a, dict) and isinstance(b, dict):
        assert a.keys() == b.keys(), where
        for key in a:
            same(a[key], b[key], f"{where}.{key}")
    elif isinstance(a, list) and isinstance(b, list):
        assert len(a) == len(b), where
        for i, pair in enumerate(zip(a, b, strict=True)):
            same(*pair, f"{where}[{i}]")
    elif isinstance(a, float) and isinstance(b, float):
        assert a == pytest.approx(b, rel=SAME), where
    else:
        assert a == b, where


def kill(job: Job, folder: Path, after_s: float) -> bool:
    """Start, kill -9 after so long; whether it was still running. Nobody of its family may live on."""
    with subprocess.Popen(
        command(*job.words, "--out", folder / "out"), stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL, env=environment(folder / "cache", folder / "tmp"),
    ) as started:  # fmt: skip
        with suppress(subprocess.TimeoutExpired):
            started.wait(after_s)
        family = []
        if started.poll() is None:
            family = psutil.Process(started.pid).children(recursive=True)
            started.kill()
    _, alive = psutil.wait_procs(family, GONE_WITHIN_S)
    # a zombie has ended; who adopted it has not asked yet
    alive = [p for p in alive if p.is_running() and p.status() != psutil.STATUS_ZOMBIE]
    assert not alive, alive
    return started.returncode == -9


def left(folder: Path) -> set[str]:
    """Unfinished files anywhere below."""
    return {p.name for p in folder.rglob(f"{MARK}*")}


def killed_and_repeated(name: str, folder: Path, kills: int, seed: int) -> tuple[int, float]:
    """How many kills hit a running process, and the longest command after one [s]."""
    rng = np.random.default_rng([9, seed])
    job = jobs(folder)[name]
    reference = folder / "reference"
    (folder / "tmp").mkdir()
    began = time.monotonic()
    done = run(*job.words, "--out", reference, cache=folder / "cache of reference")
    assert done.returncode == 0, done.stderr
    whole = time.monotonic() - began
    expected = answer(reference / job.answer)
    hits, longest = 0, 0.0
    for number in range(kills):
        here = folder / str(number)
        (here / "tmp").mkdir(parents=True)
        hits += kill(job, here, float(rng.uniform(0, LATEST * whole)))
        rubbish = left(here)
        began = time.monotonic()
        done = run(*job.words, "--out", here / "out", cache=here / "cache", scratch=here / "tmp")
        longest = max(longest, time.monotonic() - began)
        assert done.returncode == 0, done.stderr
        same(answer(here / "out" / job.answer), expected)
        assert not left(here)
        for unfinished in rubbish:
            assert unfinished in done.stderr, (unfinished, done.stderr)
    return hits, longest


def test_a_kill(tmp_path: Path) -> None:
    killed_and_repeated("backlash", tmp_path, 2, 2)


BLOCKS = [("run", i) for i in range(4)] + [
    (name, i) for i in range(3) for name in ("study", "diagnose")
]


@pytest.mark.long
@pytest.mark.parametrize(("name", "block"), BLOCKS)
def test_fifty_kills(name: str, block: int, tmp_path: Path, fact) -> None:
    hits, longest = killed_and_repeated(name, tmp_path, KILLS, 10 + block)
    outcome = f"{hits} interrupted a running command; the rerun was correct, no files left"
    fact(f"kill -9 at random moments of `{name}`, round {block + 1}", KILLS, outcome, longest)
