"""One design, one process: what two processes that want the same design get."""

from dataclasses import replace
from pathlib import Path

import pytest
from study_bench import GRID, quick, study_of

from flexspline.pipeline.study.evaluate import Task
from flexspline.pipeline.study.run import source_of, trial_store_of
from flexspline.pipeline.study.store import TrialStore

OPTIMIZE = GRID.replace('"grid"', '"optimize"').replace(", steps = 3", "")


@pytest.fixture(params=[GRID, OPTIMIZE], ids=["grid", "optimize"])
def pair(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[TrialStore, TrialStore, str]:
    """Two processes' views of one study."""
    first, second = (trial_store_of(study_of(request.param), tmp_path) for _ in range(2))
    return first, replace(second, owner="another/1/1"), request.param


def test_the_second_to_claim_a_design_gets_nothing(
    pair: tuple[TrialStore, TrialStore, str],
) -> None:
    first, second, text = pair
    source = source_of(study_of(text))
    job = source.claim(first, 0)
    assert job is not None
    assert source.claim(second, 0) is None
    assert len([t for t in first.by_slot()[0] if not t.state.is_finished()]) == 1


def test_a_claim_that_died_before_it_had_values_is_given_some(tmp_path: Path) -> None:
    study = study_of(OPTIMIZE)
    store, source = trial_store_of(study, tmp_path), source_of(study)
    bare = store.create(0, 0, {}, {})
    assert bare is not None
    store.tell(bare.number, None)
    job = source.again(store, 0, 1, store.by_slot()[0][0])
    assert job is not None
    assert set(job.values) == set(study.file.vary)
    outcome = quick(Task({}, job.values, ()))
    store.finish(job, outcome, source.objectives(outcome))
    (row,) = store.rows()
    assert row.values == job.values
