"""Local workers: one that dies is replaced, its design tried again, at most twice; a cluster's workers."""

import os
import time
from pathlib import Path

import pytest
from study_bench import GRID, WALL, quick, study_of

from flexspline.pipeline.study.cluster import worker_pool
from flexspline.pipeline.study.evaluate import Outcome, Task
from flexspline.pipeline.study.local_workers import RETRIES
from flexspline.pipeline.study.run import run_study, trial_store_of
from flexspline.pipeline.study.study import StudyError

MARKS = "FLEXSPLINE_TEST_MARKS"


def deadly(task: Task) -> Outcome:
    """Every design with a wall of 0.4 kills its worker: once for length 30, always for 25."""
    marks = Path(os.environ[MARKS])
    if task.values[WALL] == 0.4:
        length = task.values["flexspline.length_mm"]
        tried = len(list(marks.glob(f"{length:g}-*")))
        (marks / f"{length:g}-{tried}").touch()
        if length == 25 or tried == 0:
            time.sleep(1)  # by then the result before is stored: it must not be made again
            os._exit(1)
    return quick(task)


def test_a_dying_worker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(MARKS, str(tmp_path))
    study = study_of(GRID)
    rows = run_study(
        study, trial_store_of(study, tmp_path), lambda: worker_pool(1, ""), deadly
    ).rows
    assert len(rows) == 6
    (lost,) = (r for r in rows if r.outcome.reason)
    assert lost.values == {WALL: 0.4, "flexspline.length_mm": 25.0}
    assert "worker died" in lost.outcome.reason
    assert len(list(tmp_path.glob("25-*"))) == RETRIES + 1
    assert len(list(tmp_path.glob("30-*"))) == 2


def test_a_scheduler_that_does_not_answer_is_wrong_input(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("flexspline.pipeline.study.cluster.CONNECT_S", 1.0)
    with pytest.raises(StudyError) as caught, worker_pool(1, "tcp://127.0.0.1:1"):
        pytest.fail("nobody is there")
    assert "run.scheduler" in str(caught.value)


def test_a_running_scheduler_takes_the_study(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2] / "helpers"))
    from distributed import LocalCluster

    study = study_of(GRID)
    with LocalCluster(n_workers=1, protocol="tcp", dashboard_address="127.0.0.1:0") as cluster:
        address = cluster.scheduler_address
        rows = run_study(
            study, trial_store_of(study, tmp_path), lambda: worker_pool(1, address), quick
        ).rows
    assert [r.outcome for r in rows] == [quick(Task({}, r.values, ())) for r in rows]
