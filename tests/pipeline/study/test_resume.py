"""Nothing finished is lost, nothing is done twice, a dead process's designs are taken over."""

import multiprocessing
import os
import signal
import time
from pathlib import Path

import numpy as np
import pytest
from study_bench import GRID, LENGTH, WALL, quick, study_of, threads

from flexspline.pipeline.study.drive import StudyListener
from flexspline.pipeline.study.evaluate import Outcome, Task
from flexspline.pipeline.study.plan import grid
from flexspline.pipeline.study.run import run_study, source_of, trial_store_of
from flexspline.pipeline.study.store import Finished, TrialStore

SIZE = 40
OPTIMIZED = GRID.replace('"grid"', '"optimize"\nevaluations = 6').replace(", steps = 3", "")
LONG_GRID = GRID.replace("steps = 3", f"steps = {SIZE // 2}")


class Counted:
    """Appends a line per evaluation that ended; a line this short is written whole."""

    def __init__(self, path: Path, seconds: float) -> None:
        self.path, self.seconds = path, seconds

    def __call__(self, task: Task) -> Outcome:
        time.sleep(self.seconds)
        outcome = quick(task)
        with open(self.path, "ab", buffering=0) as out:
            out.write(f"{task.values[WALL]!r} {task.values[LENGTH]!r}\n".encode())
        return outcome

    def lines(self) -> list[str]:
        return self.path.read_text().splitlines() if self.path.exists() else []


def work(folder: Path, seconds: float) -> None:
    study = study_of(LONG_GRID)
    store = trial_store_of(study, folder)
    run_study(study, store, threads, Counted(folder / "done", seconds))


def started(folder: Path, seconds: float) -> multiprocessing.Process:
    process = multiprocessing.get_context("fork").Process(target=work, args=(folder, seconds))
    process.start()
    return process


def test_a_grid_has_every_combination_once(tmp_path: Path) -> None:
    study = study_of(GRID)
    rows = run_study(study, trial_store_of(study, tmp_path), threads, quick).rows
    assert sorted((r.values[WALL], r.values[LENGTH]) for r in rows) == sorted(
        (w, n) for w in (0.3, 0.4, 0.5) for n in (25.0, 30.0)
    )
    assert all(r.outcome == quick(Task({}, r.values, ())) for r in rows)


def test_values_of_a_grid_are_as_a_person_writes_them() -> None:
    study = study_of(
        GRID.replace("min = 0.3, max = 0.5, steps = 3", "min = 0.1, max = 20.0, steps = 5")
    )
    assert grid(study).axes[WALL] == [
        0.1,
        5.075,
        10.05,
        15.025,
        20.0,
    ]  # steps of 4.975, none of them 5.074999999999999


def test_the_same_command_again_evaluates_nothing(tmp_path: Path) -> None:
    study, counted = study_of(GRID), Counted(tmp_path / "done", 0.0)
    first = run_study(study, trial_store_of(study, tmp_path), threads, counted).rows
    again = run_study(study, trial_store_of(study, tmp_path), threads, counted).rows
    assert again == first
    assert len(counted.lines()) == len(first) == 6


def killed_and_resumed(folder: Path, kills: int, seed: int) -> None:
    """Kill -9 at random moments, then let it finish."""
    random = np.random.default_rng(seed)
    counted = Counted(folder / "done", 0.02)
    for _ in range(kills):
        process = started(folder, counted.seconds)
        deadline = time.monotonic() + 30
        enough = len(counted.lines()) + int(random.integers(0, 3))
        while len(counted.lines()) < min(enough, SIZE) and time.monotonic() < deadline:
            time.sleep(0.002)
        time.sleep(random.uniform(0, 0.05))
        os.kill(process.pid, signal.SIGKILL)
        process.join()
    finished = {r.slot: r for r in trial_store_of(study_of(LONG_GRID), folder).rows()}
    work(folder, counted.seconds)
    rows = {r.slot: r for r in trial_store_of(study_of(LONG_GRID), folder).rows()}
    assert sorted(rows) == list(range(SIZE))
    assert {s: rows[s] for s in finished} == finished  # nothing finished was lost or redone
    # a kill can hit two designs between their end and their rows being stored: the one thread's, and the
    # one that waited for it, where storing the first takes as long as evaluating the second
    assert SIZE <= len(counted.lines()) <= SIZE + 2 * kills
    assert len(set(counted.lines())) == SIZE


def test_killed_at_random_moments(tmp_path: Path) -> None:
    killed_and_resumed(tmp_path, 4, seed=1)


@pytest.mark.long
def test_killed_twenty_times(tmp_path: Path) -> None:
    killed_and_resumed(tmp_path, 20, seed=2)


def test_two_processes_share_a_study(tmp_path: Path) -> None:
    both = [started(tmp_path, 0.02) for _ in range(2)]
    for process in both:
        process.join(60)
        assert process.exitcode == 0
    lines = Counted(tmp_path / "done", 0).lines()
    assert len(lines) == len(set(lines)) == SIZE
    assert len(trial_store_of(study_of(LONG_GRID), tmp_path).rows()) == SIZE


def test_a_design_that_cannot_be_built_is_a_row_with_its_reason(tmp_path: Path) -> None:
    text = GRID.replace("[25.0, 30.0]", "[5.0]").replace(
        "max = 0.5, steps = 3", "max = 0.4, steps = 2"
    )
    study = study_of(text)
    result = run_study(study, trial_store_of(study, tmp_path), threads)
    assert len(result.rows) == 2
    assert result.built == ()
    assert all("ring_width_mm" in r.outcome.reason for r in result.rows)


def test_a_bug_is_no_reason(tmp_path: Path) -> None:
    def broken(task: Task) -> Outcome:
        raise ZeroDivisionError

    study = study_of(GRID)
    with pytest.raises(ZeroDivisionError):
        run_study(study, trial_store_of(study, tmp_path), threads, broken)


@pytest.mark.parametrize("at", [1, pytest.param(4, marks=pytest.mark.long)])
def test_what_was_stopped_goes_on_in_the_same_process(at: int, tmp_path: Path) -> None:
    """A notebook's: it lives on, and its own unfinished designs waited for it for ever."""
    study, heard = study_of(GRID), list[object]()

    def stop(progress: object) -> None:
        heard.append(progress)
        if len(heard) == at:
            raise KeyboardInterrupt

    slow = Counted(tmp_path / "done", 0.7)
    with pytest.raises(KeyboardInterrupt):
        run_study(study, trial_store_of(study, tmp_path), threads, slow, StudyListener(stop))
    began = time.monotonic()
    rows = run_study(study, trial_store_of(study, tmp_path), threads, quick).rows
    assert len(rows) == 6
    assert time.monotonic() - began < 20


def test_a_stop_while_a_row_is_stored_leaves_its_design_free(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = study_of(OPTIMIZED)
    told: list[int] = []

    def stop(self: TrialStore, number: int, values: list[float] | None) -> None:
        told.append(number)
        if len(told) == 2:
            raise KeyboardInterrupt
        tell(self, number, values)

    tell = TrialStore.tell
    with monkeypatch.context() as patched:
        patched.setattr(TrialStore, "tell", stop)
        with pytest.raises(KeyboardInterrupt):
            run_study(study, trial_store_of(study, tmp_path), threads, quick)
    began = time.monotonic()
    assert len(run_study(study, trial_store_of(study, tmp_path), threads, quick).rows) == 6
    assert time.monotonic() - began < 20


def test_a_study_without_an_objective_has_no_best_and_ends(tmp_path: Path) -> None:
    study = study_of(GRID.replace('[objective]\n"K_b_Nm_per_rad" = "maximize"\n', ""))
    result = run_study(study, trial_store_of(study, tmp_path), threads, quick)
    assert len(result.feasible) == 6
    assert result.best(5) == ()


def test_a_study_made_shorter_has_its_own_designs(tmp_path: Path) -> None:
    """A design that an earlier, longer one left out is none of those beyond."""
    sobol = GRID.replace(", steps = 3", "").replace("grid", "sobol") + "evaluations = "
    longer = study_of(f"{sobol}8")
    store, source = trial_store_of(longer, tmp_path), source_of(longer)
    jobs = source.claim(store, 6)
    done = [Finished(job, quick(source.task(job.values)), None) for job in jobs if job.slot != 2]
    source.store(store, done)
    store.give_up(jobs[2])
    shorter = study_of(f"{sobol}4")
    again = trial_store_of(shorter, tmp_path)
    result = run_study(shorter, again, threads, quick)
    assert [row.slot for row in result.rows] == [0, 1, 2, 3]


def test_a_study_made_shorter_waits_for_its_own_designs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One of them is at work elsewhere, while rows of an earlier, longer study are more than it asks for."""
    sobol = GRID.replace(", steps = 3", "").replace("grid", "sobol") + "evaluations = "
    longer = study_of(f"{sobol}8")
    store, source = trial_store_of(longer, tmp_path), source_of(longer)
    *done, last = sorted(source.claim(store, 6), key=lambda job: job.slot == 2)
    source.store(store, [Finished(job, quick(source.task(job.values)), None) for job in done])
    told: list[int] = []

    def finished_elsewhere(_: float) -> None:
        source.store(store, [Finished(last, quick(source.task(last.values)), None)])

    monkeypatch.setattr("flexspline.pipeline.study.drive.time.sleep", finished_elsewhere)
    shorter = study_of(f"{sobol}4")
    again = trial_store_of(shorter, tmp_path)
    result = run_study(
        shorter, again, threads, quick, StudyListener(lambda p: told.append(len(p.rows)))
    )
    assert [row.slot for row in result.rows] == [0, 1, 2, 3]
    assert told == [3, 4]
