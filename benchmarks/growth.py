"""How a study grows: `python benchmarks/growth.py` measures rows a second and what a stored row costs.

The study's own loop and storage, and Dask's own scheduler in a process of its own; workers sleep for times
that scatter as those of RECORDED real designs. Processor times stand beside the clock's, which depends on
what else the machine does.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path

import psutil
from sleepers import WAIT_S, cluster, slept
from study import EXAMPLES, STUDY

from flexspline.pipeline.study.cluster import WorkerPool, worker_pool
from flexspline.pipeline.study.drive import evaluate_all
from flexspline.pipeline.study.evaluate import evaluate
from flexspline.pipeline.study.load import study_from
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.run import source_of, trial_store_of
from flexspline.pipeline.study.study import Study
from flexspline.results.study.progress import Watch
from flexspline.results.study.tables import table_of, write_csv

RECORDED = 20
"""Real designs evaluated for their times and figures."""
CASES = ((1, 0.4), (10, 0.4), (30, 0.4), (100, 0.4), (100, 0.1))
"""Workers, and the mean time of a design [s]: 0.4 s is a real one's on a quiet core; the last looks for the
ceiling."""
SECONDS = 25.0
"""Of each case, where nothing is lost; at most MOST designs."""
MOST = 8000
SIZES = (1_000, 10_000, 100_000)
TAIL = 500
"""Designs at the end of each size over which the cost of one is taken."""
WIDTH = 100
"""Workers in whose name the storage alone is filled."""


def growing(designs: int) -> Study:
    study = study_from(tomllib.loads(STUDY), EXAMPLES, "growth")
    run = study.file.run.model_copy(update={"evaluations": designs, "seed": 1})
    return replace(study, file=study.file.model_copy(update={"run": run}))


def record(path: Path) -> float:
    """Real designs' outcomes into a file; their mean time [s]."""
    study = growing(RECORDED)
    source, found = source_of(study), []
    with tempfile.TemporaryDirectory() as folder:
        jobs = source.claim(trial_store_of(study, Path(folder)), RECORDED)
    found = [evaluate(source.task(j.values)) for j in jobs]
    path.write_text(json.dumps([asdict(o) for o in found]), encoding="utf-8")
    return sum(o.seconds for o in found) / RECORDED


def on_a_cluster(workers: int, seconds: float, share: float, path: Path) -> None:
    """Rows a second with so many workers, and whose processor time a row takes."""
    designs = int(min(MOST, SECONDS * workers / seconds))
    study = growing(designs)
    work = partial(slept, path, share)
    with (
        tempfile.TemporaryDirectory() as name,
        cluster(workers, Path(name)) as dask,
        worker_pool(1, dask.address) as pool,
    ):
        deadline = time.monotonic() + WAIT_S
        while pool.width() < workers and time.monotonic() < deadline:
            time.sleep(0.1)
        assert pool.width() == workers
        store = trial_store_of(study, Path(name))
        processes = (psutil.Process(), dask.scheduler, dask.workers)
        before = [_cpu(p) for p in processes]
        began = time.perf_counter()
        rows = evaluate_all(source_of(study), store, pool, work, lambda p: None)
        passed = time.perf_counter() - began
        own, scheduler, sleepers = (
            1e3 * (_cpu(p) - b) / designs for p, b in zip(processes, before, strict=True)
        )
    busy = share * sum(r.outcome.seconds for r in rows) / passed
    print(
        f"{workers:4} workers, {seconds:.1f} s a design: {designs / passed:6.1f} rows/s, "
        f"{busy:5.1f} at work; processor, ms a row: study {own:.2f}, "
        f"scheduler {scheduler:.2f}, all workers {sleepers:.2f}",
        flush=True,
    )


def storage_alone(path: Path, sizes: tuple[int, ...]) -> None:
    """The same loop and storage with work that takes no time, at each size; then what is read of it."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for size in sizes:
            _filled(folder, path, size - TAIL)
            rows_per_s, cpu_ms = _filled(folder, path, size)
            study_MB = (folder / "study.db").stat().st_size / 1e6
            memory_MB = psutil.Process().memory_info().rss / 1e6
            began = time.process_time()
            rows = tuple(trial_store_of(growing(size), folder).rows())
            read = time.process_time()
            write_csv(folder / "study.csv", table_of(StudyResult(growing(size), rows)))
            written = time.process_time()
            print(
                f"{size:6} rows: the last {TAIL} at {rows_per_s:.0f} rows/s, {cpu_ms:.2f} ms of the "
                f"processor each; study.db {study_MB:.1f} MB, the study's process {memory_MB:.0f} MB; "
                f"read again in {read - began:.1f} s, study.csv in {written - read:.1f} s",
                flush=True,
            )


def _filled(folder: Path, path: Path, designs: int) -> tuple[float, float]:
    """A study's rows up to so many; of the new ones rows a second, and processor time of each [ms]."""
    study = growing(designs)
    store = trial_store_of(study, folder)
    new = designs - len(store.rows())
    cpu, began = time.process_time(), time.perf_counter()
    with _at_once() as pool:
        evaluate_all(source_of(study), store, pool, partial(slept, path, 0.0), Watch(study))
    return new / (time.perf_counter() - began), 1e3 * (time.process_time() - cpu) / new


@contextmanager
def _at_once() -> Iterator[WorkerPool]:
    with ThreadPoolExecutor(1) as executor:
        yield WorkerPool(executor, lambda: WIDTH)


def _cpu(process: psutil.Process) -> float:
    """Processor time of a process so far [s]."""
    times = process.cpu_times()
    return float(times.user + times.system)


def main() -> None:
    print(f"load average before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recorded.json"
        mean = record(path)
        print(f"{RECORDED} real designs: {mean:.2f} s each")
        if "storage" not in sys.argv:
            for workers, seconds in CASES:
                on_a_cluster(workers, seconds, seconds / mean, path)
        if "cluster" not in sys.argv:
            storage_alone(path, SIZES)
    print(f"load average after: {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
