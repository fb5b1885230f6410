"""Random designs: each is refused, or answered with finite K between bounds."""

from __future__ import annotations

import json
import time
import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count, islice
from math import isfinite
from pathlib import Path

import pytest
from in_process import flexspline
from random_designs import design_of, toml
from reliability_page import counted

from flexspline.fea.solid.sweeps import goes_about_axis
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import design_from
from flexspline.pipeline.study.evaluate import Task, evaluate

FAST, FAST_BLOCK = 2000, 500
SOLID = {"swept": (160, 5), "meshed": (40, 4)}
"""How many designs of each sort, and how many in a block."""
SORTS = {
    "swept": "their prisms swept from the meridian",
    "meshed": "one or both parts in layers or by fTetWild",
}
HANG_S = 1800.0
"""Beyond six time limits of the mesher something hangs: two parts, three attempts each."""


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


def solid_designs(sort: str) -> Iterator[tuple[int, dict]]:
    """Designs that load, asked for by the solid model, coarse enough for hundreds of them."""
    for seed in count():
        tables = design_of(100_000 + seed, slips=False)
        tables["solver"] = {"model": "solid", "tolerance_pct": 5.0}
        try:
            design = design_from(tomllib.loads(toml(tables)))
        except DesignError:
            continue
        swept = all(goes_about_axis(design.part(part)) for part in ("flexspline", "shaft"))
        if swept == (sort == "swept"):
            yield seed, tables


def solid(sort: str, first: int, after: int, folder: Path) -> list[Tried]:
    found = []
    for seed, tables in islice(solid_designs(sort), first, after):
        began = time.perf_counter()
        status, reason = by_command(toml(tables), folder)
        word = ("answered", "failed", "refused")[status]
        found.append(Tried(seed, word, time.perf_counter() - began, reason))
        print(found[-1], flush=True)
    assert max(t.seconds for t in found) < HANG_S
    return found


def told(fact, tried: str, found: list[Tried]) -> None:
    fact(tried, len(found), counted(Counter(t.word for t in found)), max(t.seconds for t in found))


def test_eight_designs(tmp_path: Path, cache: None) -> None:
    found = [fast(seed, tmp_path) for seed in range(5000, 5008)]
    words = Counter(t.word for t in found)
    assert words["answered"] > 1
    assert words["refused"] > 0
    assert not [t for t in found if t.word == "failed"]


@pytest.mark.long
def test_a_solid_design(tmp_path: Path, cache: None) -> None:
    assert {t.word for t in solid("swept", 0, 1, tmp_path)} == {"answered"}


@pytest.mark.long
@pytest.mark.parametrize("first", range(0, FAST, FAST_BLOCK))
def test_two_thousand_designs(first: int, tmp_path: Path, cache: None, fact) -> None:
    found = [fast(seed, tmp_path) for seed in range(first, first + FAST_BLOCK)]
    assert not [t for t in found if t.word == "failed"]
    assert max(t.seconds for t in found) < HANG_S
    told(fact, f"random designs over the schema and beyond, from number {first}, fast model", found)


BLOCKS = [(sort, first) for sort, (all_, n) in SOLID.items() for first in range(0, all_, n)]


@pytest.mark.long
@pytest.mark.parametrize(("sort", "first"), BLOCKS)
def test_two_hundred_solid_designs(
    sort: str, first: int, tmp_path: Path, cache: None, fact
) -> None:
    found = solid(sort, first, first + SOLID[sort][1], tmp_path)
    # a mesh that passes no check or finds no end is said, never a wrong answer; rare where none is asked for
    failed = [t for t in found if t.word == "failed"]
    assert len(failed) <= (0 if sort == "swept" else len(found) / 2), failed
    told(fact, f"random designs that load, {SORTS[sort]}, from number {first}, solid model", found)
