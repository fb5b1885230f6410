"""The same input gives the same K: on one thread and two, a second time, and on a new mesh."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import bases
import pytest
from example_files import EXAMPLES
from shell import run

from flexspline.fea.solid.stiffness import near_step
from flexspline.geometry.percent import percent

SAME = 1e-9
"""Relative, on the same mesh: threads add in another order, and the conditioning (1e6) magnifies 1e-16."""
KEPT_STAGE = "mesh"
KEYED = EXAMPLES / "keyed-shaft.toml"
K = ("K_b", "K_e")


def coarse(design: Path, folder: Path, tolerance_pct: float) -> Path:
    """A copy of a design that asks for less."""
    text = design.read_text(encoding="utf-8").partition("\n[solver]")[0]
    path = folder / design.name
    path.write_text(f"{text}\n[solver]\ntolerance_pct = {tolerance_pct}\n", encoding="utf-8")
    return path


def solved(design: Path, cache: Path, folder: Path, threads: int = 1) -> dict:
    done = run("stiffness", design, "--out", folder, "--json", cache=cache, threads=threads)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def only_meshes(cache: Path) -> None:
    """Forget every answer but the meshes."""
    for stage in cache.iterdir():
        if stage.name != KEPT_STAGE:
            shutil.rmtree(stage)


def check_threads(design: Path, folder: Path) -> float:
    """K of one thread, two threads on the same mesh, and once more; the largest difference, relative."""
    cache, out = folder / "cache", folder / "out"
    first = solved(design, cache, out)
    again = [solved(design, cache, out)]
    for threads in (2, 1):
        only_meshes(cache)
        again.append(solved(design, cache, out, threads))
    differences = [
        abs(other[f"{name}_Nm_per_rad"] / first[f"{name}_Nm_per_rad"] - 1)
        for other in again
        for name in (*K, *(("K_b_lobes",) if "K_b_lobes_Nm_per_rad" in first else ()))
    ]
    assert max(differences) < SAME
    return max(differences)


@pytest.mark.long
def test_threads_of_a_body_of_revolution(tmp_path: Path) -> None:
    check_threads(bases.plain(tmp_path, tolerance_pct=2.0), tmp_path)


def test_rounding_asks_for_no_other_mesh() -> None:
    """A part that fTetWild meshes in two steps was meshed again on two threads: K moved by its bounds."""
    assert near_step(0.005, 0.0081) == near_step(0.005, 0.0081 * (1 + 1e-12))


@pytest.mark.long
@pytest.mark.parametrize("design", [bases.CUP, KEYED], ids=lambda p: p.stem)
def test_threads(design: Path, tmp_path: Path, fact) -> None:
    largest = check_threads(design, tmp_path)
    outcome = f"K within {largest:.1e}, demanded {SAME:g}"
    fact(f"one thread, again, two threads, one thread, on one mesh: {design.name}", 4, outcome)


@pytest.mark.long
def test_new_meshes(tmp_path: Path, fact) -> None:
    """fTetWild's meshes differ from run to run; bounds of the same K must then meet."""
    design = coarse(KEYED, tmp_path, 1.0)
    found = [solved(design, tmp_path / f"cache {i}", tmp_path / "out") for i in range(3)]
    for name in K:
        bounds = [r[f"{name}_bounds_Nm_per_rad"] for r in found]
        for record in found:
            assert all(low <= record[f"{name}_Nm_per_rad"] <= high for low, high in bounds)
    K_e = [r["K_e_Nm_per_rad"] for r in found]
    spread = (max(K_e) - min(K_e)) / min(K_e)
    outcome = f"each K_e within all bounds (± 1 % asked); {percent(spread)} apart"
    fact(f"a new mesh each time: {design.name}", 3, outcome)
