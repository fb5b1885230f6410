"""Fast and solid model side by side; a disagreement beyond the bounds is seen."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from example_files import EXAMPLES
from study_bench import TWO_WALLS, quick, study_of, threads

from flexspline.fea.deadline import OutOfTimeError
from flexspline.fea.errors import MemoryShortError
from flexspline.geometry.design import Solver
from flexspline.geometry.errors import GeometryError
from flexspline.geometry.keys import without_holes
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.cluster import WorkerPool
from flexspline.pipeline.study.evaluate import Outcome, Task, evaluate
from flexspline.pipeline.study.local_workers import WORKER_DIED, WorkerDiedError
from flexspline.pipeline.study.run import run_study, trial_store_of
from flexspline.pipeline.study.verify import checked

TEXT = f"{TWO_WALLS}verify = 1\n"


def figures(K: float, half: float) -> dict[str, float]:
    bounds = "K_b_bounds_Nm_per_rad"
    return {"K_b_Nm_per_rad": K, f"{bounds}[0]": K - half, f"{bounds}[1]": K + half}


@pytest.mark.parametrize(("solid", "agrees"), [(1015.0, True), (1025.0, False), (975.0, False)])
def test_intervals_that_do_not_meet_are_an_alarm(solid: float, agrees: bool) -> None:
    row = Row(3, {}, Outcome(figures(1000.0, 10.0)))
    (check,) = checked(row, Outcome(figures(solid, 10.0)), Solver()).checks
    assert check.agrees is agrees
    assert check.difference_pct == pytest.approx((solid - 1000.0) / 10.0)


def test_the_solid_model_of_a_part_without_holes_agrees(tmp_path: Path) -> None:
    study = study_of(TEXT)
    plain = replace(study, design=without_holes(study.design))

    def torsion(task: Task) -> Outcome:
        return evaluate(replace(task, solves=("torsion",)))

    result = run_study(plain, trial_store_of(plain, tmp_path), threads, torsion)
    (verified,) = result.verified
    assert verified.slot == result.pareto[0].slot
    assert {c.key for c in verified.checks} == {
        "K_b_Nm_per_rad", "K_e_Nm_per_rad", "backlash_arcsec.total",
    }  # fmt: skip
    assert all(c.agrees for c in verified.checks)
    assert all(abs(c.difference_pct) > 0 for c in verified.checks)  # two models, not one twice


@contextmanager
def mortal() -> Iterator[WorkerPool]:
    """A thread whose deaths are told as those of a local worker."""
    with threads() as pool:
        yield replace(pool, lost=(WorkerDiedError,))


def failing(fault: Exception) -> Callable[..., None]:
    def fails(*_: object, **__: object) -> None:
        raise fault

    return fails


def reason_of(folder: Path) -> str:
    """Of the best design of a study that is begun, or gone on with, in a folder."""
    study = study_of(TEXT)
    result = run_study(study, trial_store_of(study, folder), mortal, quick)
    (verified,) = result.verified
    return verified.reason


@pytest.mark.parametrize(
    ("where", "fault", "kept"),
    [
        ("pipeline.study.verify.solid_answer", WorkerDiedError(WORKER_DIED), False),
        ("pipeline.figure_tasks.part_stiffness", OutOfTimeError(1.0), False),
        ("pipeline.figure_tasks.part_stiffness", MemoryShortError(9, 9e9, 1e9), False),
        ("pipeline.figure_tasks.part_stiffness", MemoryError("no room"), False),
        ("pipeline.study.verify.stiffnesses", MemoryError(), False),
        ("pipeline.figure_tasks.part_stiffness", GeometryError("a hole has no mesh"), True),
    ],
)
def test_what_time_or_memory_was_too_short_for_is_solved_again(
    where: str, fault: Exception, kept: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A passing failure is said, and ends no study; the next run of it has another answer."""
    with monkeypatch.context() as once:
        once.setattr(f"flexspline.{where}", failing(fault))
        first = reason_of(tmp_path)
    assert first
    monkeypatch.setattr(
        "flexspline.pipeline.figure_tasks.part_stiffness", failing(GeometryError("solved again"))
    )
    again = reason_of(tmp_path)
    assert again == first if kept else "solved again" in again


def test_examples_are_studies() -> None:
    from flexspline.pipeline.study.load import load_study

    methods = {load_study(p).file.run.method for p in sorted((EXAMPLES / "studies").glob("*.toml"))}
    assert methods == {"grid", "sobol", "optimize", "tolerance"}
