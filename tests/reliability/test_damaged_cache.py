"""Cache entries damaged at random, two processes on one cache, a clock set back: the answer stays."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import bases
import numpy as np
import pytest
from in_process import Ended, flexspline
from shell import command, environment

Damage = Callable[[Path, np.random.Generator, list[Path]], None]
SAME = 1e-9
"""Relative: what is made again from the same meshes, sums of threads in any order."""
FUTURE_S = 20 * 365 * 86400.0


def flipped(path: Path, rng: np.random.Generator, others: list[Path]) -> None:
    data = bytearray(path.read_bytes())
    for at in rng.integers(0, len(data), int(rng.integers(1, 200))):
        data[at] ^= 1 << int(rng.integers(8))
    path.write_bytes(data)


def cut(path: Path, rng: np.random.Generator, others: list[Path]) -> None:
    os.truncate(path, int(rng.integers(0, path.stat().st_size)))


def zeros(path: Path, rng: np.random.Generator, others: list[Path]) -> None:
    """What a power cut leaves: the length, and no data."""
    path.write_bytes(b"\0" * path.stat().st_size)


def another(path: Path, rng: np.random.Generator, others: list[Path]) -> None:
    """Another question's whole and healthy answer under this name."""
    shutil.copyfile(others[int(rng.integers(len(others)))], path)


def folder(path: Path, rng: np.random.Generator, others: list[Path]) -> None:
    path.unlink()
    (path / "in").mkdir(parents=True)


def stuffed(path: Path, rng: np.random.Generator, others: list[Path]) -> None:
    """The right arrays, all filled with nonsense by somebody who knew the format."""
    with np.load(path) as entry:
        arrays = {name: entry[name] for name in entry.files}
    arrays["json"] = np.frombuffer(b'{"key": 1, "value": {"type": "os", "fields": {}}}', np.uint8)
    np.savez(path, **arrays)  # type: ignore[arg-type]


def gone(path: Path, rng: np.random.Generator, others: list[Path]) -> None:
    path.unlink()


DAMAGES: tuple[Damage, ...] = (flipped, cut, zeros, another, folder, stuffed, gone)
SILENT = (gone,)
"""No entry is no fault."""


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def figures(ended: Ended) -> dict[str, object]:
    """result.json as printed, without the time it took."""
    assert ended.status == 0, ended
    record = json.loads(ended.stdout)
    record["solver"].pop("wall_s")
    return record


def same(a: object, b: object) -> bool:
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[k], b[k]) for k in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, float) and isinstance(b, float):
        return abs(a - b) <= SAME * abs(b)
    return a == b


def damaged(design: Path, cache: Path, where: Path, rounds: int) -> int:
    """Damage one entry or more, ask again, each round; how many entries were discarded."""
    rng = np.random.default_rng(11)
    words = ("stiffness", design, "--out", where / "out", "--json")
    expected = figures(flexspline(*words, folder=where))
    discarded = 0
    for number in range(rounds):
        damage = DAMAGES[number % len(DAMAGES)]
        entries = sorted(p for p in cache.rglob("*.npz") if p.is_file())
        most = min(3, len(entries) - 1)  # one stays whole, to be copied from
        hit = rng.choice(len(entries), int(rng.integers(1, most + 1)), replace=False)
        for i in hit:
            others = [p for k, p in enumerate(entries) if k not in hit]
            damage(entries[i], rng, others)
        ended = flexspline(*words, folder=where)
        assert same(figures(ended), expected), damage
        said = [entries[i].name for i in hit if f"entry {entries[i].name} (" in ended.stderr]
        discarded += len(said)
        if damage in SILENT:
            assert not said
        for i in hit:  # what was read is said and mended; the rest was not needed
            if entries[i].name not in said and damage not in (*SILENT, flipped):
                entries[i].unlink() if entries[i].is_file() else shutil.rmtree(entries[i])
    return discarded


def test_seven_damages(cache: Path, tmp_path: Path) -> None:
    assert damaged(bases.plain(tmp_path), cache, tmp_path, len(DAMAGES)) >= 5


@pytest.mark.long
@pytest.mark.parametrize(("name", "rounds"), [("plain", 140), ("xb1-40", 28)])
def test_random_damage(name: str, rounds: int, cache: Path, tmp_path: Path, fact) -> None:
    design = bases.plain(tmp_path) if name == "plain" else bases.CUP
    discarded = damaged(design, cache, tmp_path, rounds)
    assert discarded > rounds / 2
    outcome = f"{discarded} entries discarded with a message; the same figures within {SAME:g}"
    fact(f"cache entries damaged at random, {design.name}", rounds, outcome)


@pytest.mark.long  # two that share the work by default: tests/pipeline/test_second_process.py
def test_two_processes_on_one_cache(tmp_path: Path, fact) -> None:
    """Both begin with an empty one; each has its own folder."""
    design = bases.plain(tmp_path)
    both = [
        subprocess.Popen(
            command("stiffness", design, "--out", tmp_path / name, "--json"), stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, env=environment(tmp_path / "cache"),
        )
        for name in ("a", "b")
    ]  # fmt: skip
    records = []
    for process in both:
        out, err = process.communicate(timeout=600)
        assert process.returncode == 0, err
        assert "discarded" not in err
        records.append(json.loads(out))
        records[-1]["solver"].pop("wall_s")
    assert same(*records)
    assert not [p for p in tmp_path.rglob(".flexspline-*")]
    fact("two processes on one empty cache", 2, "both answered, the same figures")


@pytest.mark.long
def test_a_clock_set_back(
    cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fact
) -> None:
    """All that is kept comes from the future: entries, results and a study's trials."""
    design = bases.plain(tmp_path)
    stiffness = ("stiffness", design, "--out", tmp_path / "out", "--json")
    file = tmp_path / "study.toml"
    file.write_text(bases.study(tmp_path), encoding="utf-8")
    study = ("study", file, "--out", tmp_path / "studied", "--json")
    monkeypatch.setattr("flexspline.pipeline.study.cluster.worker_pool", bases.pool)
    expected = figures(flexspline(*stiffness, folder=tmp_path))
    found = flexspline(*study, folder=tmp_path)
    real = time.time
    monkeypatch.setattr(time, "time", lambda: real() - FUTURE_S)
    for path in tmp_path.rglob("*"):
        if path.is_file():
            os.utime(path, (real() + FUTURE_S, real() + FUTURE_S))
    again = flexspline(*stiffness, folder=tmp_path)
    assert figures(again) == expected
    assert "axisymmetric bounds" not in again.stderr  # answered by what was kept
    resumed = flexspline(*study, folder=tmp_path)
    assert "4 designs are already finished" in resumed.stderr
    assert json.loads(resumed.stdout)["best"] == json.loads(found.stdout)["best"]
    longer = file.read_text().replace("evaluations = 4", "evaluations = 8")
    file.write_text(longer)
    assert flexspline(*study, folder=tmp_path).status == 0
    fact("the clock set back by 20 years between two runs", 3, "answered, what was kept is used")
