"""Random designs: each is refused by the contract, or answered with finite K between bounds."""

from __future__ import annotations

import json
import time
import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

import pytest
from in_process import flexspline
from random_designs import design_of, toml
from reliability_page import counted

from geometry.design import Design
from geometry.errors import DesignError
from geometry.load import design_from
from pipeline.study.evaluate import Task, evaluate

SOLID_TRIED = 200
HANG_S = 900.0
"""Beyond three time limits of the mesher something hangs."""


@dataclass(frozen=True)
class Tried:
    """A design's number, what came of it, how long it took, and the reason if there was one."""

    seed: int
    word: str
    seconds: float
    reason: str = ""


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(tmp_path / "cache"))


def checked_K(figures: dict[str, float], name: str, low: float, high: float) -> None:
    K = figures[f"{name}_Nm_per_rad"]
    assert 0 < low <= K <= high, (name, low, K, high)
    assert isfinite(high)


def by_command(text: str, folder: Path) -> tuple[int, str]:
    """Status and reason of `flexspline backlash` without K."""
    path = folder / "design.toml"
    path.write_text(text, encoding="utf-8")
    ended = flexspline("backlash", path, "--out", folder / "out", "--json", folder=folder)
    if ended.status == 0:
        result = json.loads(ended.stdout)
        for name in ("K_b", "K_e"):
            checked_K(result, name, *result[f"{name}_bounds_Nm_per_rad"])
    return ended.status, ended.said[0] if ended.said else ""


def by_study(tables: dict) -> str:
    """The fast model as a study asks it, holes and keyway left out; the reason why not, or ""."""
    outcome = evaluate(Task(tables, {}, ("torsion",)))
    for name in ("K_b", "K_e") if not outcome.reason else ():
        figures, bounds = dict(outcome.figures), f"{name}_bounds_Nm_per_rad"
        checked_K(figures, name, figures[f"{bounds}[0]"], figures[f"{bounds}[1]"])
    return outcome.reason


def fast(seed: int, folder: Path) -> Tried:
    """One design by the fast model."""
    tables = design_of(seed)
    text = toml(tables)
    began = time.perf_counter()
    try:
        design: Design | None = design_from(tomllib.loads(text))
    except DesignError:
        design = None
    if design is not None and has_holes(design):
        reason = by_study(tomllib.loads(text))
        word = "failed" if reason else "answered"
    else:
        status, reason = by_command(text, folder)
        word = ("answered", "failed", "refused")[status]
        if design is None:
            assert word == "refused", (seed, reason)
        elif word == "refused":  # only what the teeth need beyond the file's own rules
            assert "flexspline.teeth" in reason, (seed, reason)
    return Tried(seed, word, time.perf_counter() - began, reason)


def has_holes(design: Design) -> bool:
    return bool(design.flexspline.bolt_count or design.shaft.bolt_count or design.shaft.keyway)


def solid_designs() -> Iterator[tuple[int, dict]]:
    """Designs that load, asked for by the solid model, coarse enough for hundreds of them."""
    seed = 0
    while True:
        tables = design_of(100_000 + seed, slips=False)
        tables["solver"] = {"model": "solid", "tolerance_pct": 5.0}
        try:
            design_from(tomllib.loads(toml(tables)))
            yield seed, tables
        except DesignError:
            pass
        seed += 1


def solid(number: int, folder: Path) -> list[Tried]:
    found = []
    for (seed, tables), _ in zip(solid_designs(), range(number), strict=False):
        began = time.perf_counter()
        status, reason = by_command(toml(tables), folder)
        word = ("answered", "failed", "refused")[status]
        found.append(Tried(seed, word, time.perf_counter() - began, reason))
        print(found[-1], flush=True)
    return found


def told(fact, tried: str, found: list[Tried]) -> None:
    fact(tried, len(found), counted(Counter(t.word for t in found)), max(t.seconds for t in found))


def test_a_hundred_designs(tmp_path: Path, cache: None) -> None:
    found = [fast(seed, tmp_path) for seed in range(5000, 5100)]
    words = Counter(t.word for t in found)
    assert words["answered"] > 30
    assert words["refused"] > 20
    assert not [t for t in found if t.word == "failed"]


def test_five_solid_designs(tmp_path: Path, cache: None) -> None:
    assert {t.word for t in solid(5, tmp_path)} == {"answered"}


@pytest.mark.long
def test_two_thousand_designs(tmp_path: Path, cache: None, fact) -> None:
    found = [fast(seed, tmp_path) for seed in range(2000)]
    assert not [t for t in found if t.word == "failed"]
    assert max(t.seconds for t in found) < HANG_S
    told(fact, "random designs over the schema and beyond, fast model", found)


@pytest.mark.long
def test_two_hundred_solid_designs(tmp_path: Path, cache: None, fact) -> None:
    found = solid(SOLID_TRIED, tmp_path)
    failed = [t for t in found if t.word == "failed"]
    # a mesh that passes no check or finds no end is a failure that says so, never a wrong answer
    assert len(failed) <= SOLID_TRIED // 20, failed
    assert max(t.seconds for t in found) < HANG_S
    told(fact, "random designs that load, solid model", found)
