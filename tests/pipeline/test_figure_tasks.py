"""The figures of a design are the same by two threads and by two processes."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from example_files import EXAMPLES

from flexspline.fea.types import Stiffness
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.load import load_design
from flexspline.pipeline import figure_tasks
from flexspline.pipeline.analysis import stiffnesses
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.rim_case import RIM_CASES, figure_of
from flexspline.pipeline.second_process import second_process
from flexspline.pipeline.stiffnesses import FIGURES, Stiffnesses

DESIGN = load_design(EXAMPLES / "xb1-40.toml").changed(
    {"flexspline.bolt_count": 0, "shaft.bolt_count": 0, "solver.tolerance_pct": 2.0}
)
linux = pytest.mark.skipif(sys.platform != "linux", reason="one process only")


def found(folder: Path, told: list[str]) -> tuple[Stiffnesses, AnalysisContext]:
    context = AnalysisContext(DESIGN, Cache(folder, told.append), Progress())
    return stiffnesses(context, solved=lambda part: told.append(part.name)), context


def test_one_answer(tmp_path: Path) -> None:
    by_threads, by_processes = list[str](), list[str]()
    one, first = found(tmp_path / "threads", by_threads)
    with second_process():
        other, second = found(tmp_path / "processes", by_processes)
    assert one == other
    assert sorted(by_threads) == sorted(by_processes) == ["flexspline", "shaft"]
    assert first.progress.seconds.keys() == second.progress.seconds.keys()


@linux
def test_what_the_disk_does_not_take_is_solved_once(tmp_path: Path) -> None:
    """The first process remembers what its copy solved."""
    nowhere = tmp_path / "a file"
    nowhere.touch()
    with second_process():
        _, context = found(nowhere, [])
    known = len(context.cache.passing)
    assert known >= 7  # a stage or more for each figure
    again = stiffnesses(context)
    assert len(context.cache.passing) == known
    assert tuple(again.solved) == FIGURES


@pytest.mark.parametrize("processes", [1, 2])
def test_what_fails_costs_its_own_figure(
    processes: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(part: PartModel, case: str) -> Stiffness:
        raise ComputationError(f"{case} of {part.name}")

    monkeypatch.setattr(figure_tasks, "rim_stiffness", fails)
    if processes == 1:
        answer, _ = found(tmp_path, [])
    else:
        with second_process():
            answer, _ = found(tmp_path, [])
    assert [*answer.solved] == ["K_b", "K_e"]
    assert {name: str(why) for name, why in answer.missing.items()} == {
        figure_of(case): f"{case} of flexspline" for case in RIM_CASES
    }
