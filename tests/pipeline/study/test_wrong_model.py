"""Less material that comes out stiffer is an error of the program: the study stops and says so."""

from __future__ import annotations

from pathlib import Path

import pytest
from example_files import EXAMPLES
from study_bench import TWO_WALLS, WALL, study_of, threads

from flexspline.fea.types import Stiffness
from flexspline.geometry.load import load_design
from flexspline.pipeline import enclosure
from flexspline.pipeline.enclosure import Names, NestingError
from flexspline.pipeline.study import holes
from flexspline.pipeline.study.evaluate import Outcome, Task, evaluate, fast_K_e
from flexspline.pipeline.study.figures import Solve
from flexspline.pipeline.study.holes import holes_of
from flexspline.pipeline.study.run import run_study, trial_store_of


@pytest.fixture
def wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cut and whole body change places."""
    between = enclosure.between

    def turned(cut: Stiffness, whole: Stiffness, names: Names) -> Stiffness:
        return between(whole.times(1.1), cut, names)

    monkeypatch.setattr(enclosure, "between", turned)


@pytest.mark.parametrize("solve", ["torsion", "lobes"])
@pytest.mark.usefixtures("wrong")
def test_it_is_no_missing_figure(solve: Solve) -> None:
    """Neither of K_b, whose bounds are theorems, nor of a case of the rim."""
    task = Task(load_design(EXAMPLES / "xb1-40.toml").tables, {WALL: 0.42}, (solve,))
    with pytest.raises(NestingError, match=f"design with {WALL} = 0.42: .* please report"):
        evaluate(task)


@pytest.mark.usefixtures("wrong")
def test_the_study_stops_and_keeps_no_row_of_it(tmp_path: Path) -> None:
    study = study_of(TWO_WALLS)

    def torsion(task: Task) -> Outcome:
        return evaluate(Task(task.tables, task.values, ("torsion",)))

    store = trial_store_of(study, tmp_path)
    with pytest.raises(NestingError, match=WALL):
        run_study(study, store, threads, lambda p: None, torsion)
    assert not list(store.rows())


def test_so_does_the_solve_that_tells_what_the_shafts_holes_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fails(*given: object) -> Stiffness:
        raise NestingError("the shaft", 2.0, "the shaft without holes", 1.0)

    monkeypatch.setattr(holes, "part_stiffness", fails)
    with pytest.raises(NestingError):
        holes_of(load_design(EXAMPLES / "xb1-40.toml"), fast_K_e, lambda line: None)
