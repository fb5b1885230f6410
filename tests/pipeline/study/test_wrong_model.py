"""Less material that comes out stiffer is an error of the program: it costs its design, not the study."""

from __future__ import annotations

from pathlib import Path

import pytest
from example_files import EXAMPLES
from study_bench import TWO_WALLS, WALL, study_of, threads
from wrong_models import swap_bodies

from flexspline.fea.types import Stiffness
from flexspline.geometry.load import load_design
from flexspline.pipeline.enclosure import check_against
from flexspline.pipeline.errors import NestingError
from flexspline.pipeline.study import holes, verify
from flexspline.pipeline.study.evaluate import Outcome, Task, evaluate, fast_K_e
from flexspline.pipeline.study.figures import USUAL_FIGURES, Solve
from flexspline.pipeline.study.holes import holes_of
from flexspline.pipeline.study.local_workers import LocalWorkers
from flexspline.pipeline.study.run import run_study, trial_store_of
from flexspline.pipeline.study.verify import solid_answer

K_ABOUT = {"torsion": 31_300.0, "lobes": 26_800.0}
"""Of the example cup [N·m/rad]."""


@pytest.fixture
def swapped(monkeypatch: pytest.MonkeyPatch) -> None:
    swap_bodies(monkeypatch)


def fails(*given: object, **named: object) -> None:
    raise NestingError("the shaft", 2.0, "the shaft without holes", 1.0)


@pytest.mark.parametrize("solve", ["torsion", "lobes"])
@pytest.mark.usefixtures("swapped")
def test_it_is_no_missing_figure(solve: Solve) -> None:
    """Neither of K_b, whose bounds are theorems, nor of a case of the rim."""
    task = Task(load_design(EXAMPLES / "xb1-40.toml").tables, {WALL: 0.42}, (solve,))
    found = evaluate(task)
    assert found.contradicted
    assert not found.figures
    (fault,) = found.faults
    assert fault.endswith("please report the design file")
    softer = float(fault.split(" N·m/rad")[0].split()[-1])
    assert 0.7 < softer / K_ABOUT[solve] < 1.5  # the part's, not that of 1 GPa


def test_the_other_designs_keep_their_rows(tmp_path: Path) -> None:
    """One of two designs; the second run finds both rows."""
    study = study_of(TWO_WALLS)

    def thin_is_wrong(task: Task) -> Outcome:
        if task.values[WALL] < 0.4:
            return Outcome(faults=("one of two solutions is wrong",), contradicted=True)
        return Outcome(dict.fromkeys(USUAL_FIGURES, 1.0))

    def refuses(task: Task) -> Outcome:
        raise AssertionError("each design has a row")

    store = trial_store_of(study, tmp_path)
    first = run_study(study, store, threads, thin_is_wrong)
    again = run_study(study, store, threads, refuses)
    for result in (first, again):
        assert [row.outcome.contradicted for row in result.rows] == [True, False]
        assert [row.slot for row in result.built] == [1]


def test_it_ends_the_solve_that_tells_what_the_shafts_holes_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(holes, "part_stiffness", fails)
    with pytest.raises(NestingError):
        holes_of(load_design(EXAMPLES / "xb1-40.toml"), fast_K_e, lambda line: None)


def test_so_is_it_where_the_best_are_verified(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verify, "stiffnesses", fails)
    task = Task(load_design(EXAMPLES / "xb1-40.toml").tables, {}, ("torsion",))
    answer = solid_answer(task, rim=False)
    assert answer.outcome.contradicted
    assert not answer.passing


def test_it_comes_back_from_a_worker_as_what_it_is() -> None:
    """From a process of its own, as from a cluster: with its numbers, and no worker is taken for dead."""
    solid = Stiffness(1100.0, 1090.0, 1110.0, False, "solid", "", "", ())
    enclosure = Stiffness(1000.0, 998.0, 1002.0, True, "axisymmetric", "", "", ())
    with LocalWorkers(1) as workers, pytest.raises(NestingError) as caught:
        workers.submit(check_against, solid, enclosure).result()
    assert (caught.value.softer_Nm_per_rad, caught.value.stiffer_Nm_per_rad) == (1090.0, 1002.0)
