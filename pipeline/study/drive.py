"""The loop of a study: claim a design, have it evaluated, store its row; until all are done."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from flexspline.pipeline.study.cluster import WorkerPool
from flexspline.pipeline.study.evaluate import Outcome, Task
from flexspline.pipeline.study.local_workers import WORKER_DIED
from flexspline.pipeline.study.store import BEAT_S, CLAIM, ROW, Job, Row, TrialStore

if TYPE_CHECKING:
    from optuna.trial import FrozenTrial

POLL_S = 1.0
"""How long to wait for a result before looking after the rest."""
WATCH_S = 0.5
"""Rows are read anew for it: a hundredth of a second for a thousand."""


class Source(Protocol):
    """Where designs come from and what their objectives are."""

    @property
    def size(self) -> int:
        """How many designs the study wants."""

    @property
    def ahead(self) -> int:
        """How many designs wait for a free worker, so that none is idle between two designs."""

    def claim(self, store: TrialStore, slot: int) -> Job | None:
        """A design for a slot that nobody had before; None where another process was faster."""

    def again(self, store: TrialStore, slot: int, attempt: int, before: FrozenTrial) -> Job | None:
        """The same design once more."""

    def task(self, values: Mapping[str, float]) -> Task:
        """What a worker is to do."""

    def objectives(self, outcome: Outcome) -> list[float] | None:
        """What Optuna is told; None for a design that has no figures."""


@dataclass(frozen=True)
class Progress:
    """How far a study is: all rows, how many came since `seconds` ago, how many are wanted.

    Rows of other processes that share the study count too: they shorten the time that is left.
    """

    rows: list[Row]
    fresh: int
    seconds: float
    size: int


def evaluate_all(
    source: Source,
    store: TrialStore,
    pool: WorkerPool,
    evaluate: Callable[[Task], Outcome],
    watch: Callable[[Progress], None],
) -> list[Row]:
    """Evaluate until every design has a row, whoever made it; the rows by slot.

    `watch` hears of finished designs at most every WATCH_S, of what other processes do while it
    waits for them, and of the end. An error that is not ours ends the study: what is finished is stored.
    """
    began = beaten = watched = time.monotonic()
    pending: dict[Future, Job] = {}
    _adopt(source, store)
    before = len(store.rows())

    def tell() -> list[Row]:
        rows = store.rows()
        watch(Progress(rows, len(rows) - before, time.monotonic() - began, source.size))
        return rows

    store.beat()
    while True:
        while len(pending) < pool.width() + source.ahead:
            job = _next(source, store)
            if job is None:
                break
            pending[pool.submit(evaluate, source.task(job.values))] = job
        if not pending:
            rows = tell()
            if len(rows) >= source.size:
                return rows
            time.sleep(POLL_S)  # another process has the rest; should it die, they come to us
            _adopt(source, store)
        else:
            stored = _store_finished(pending, pool, source, store)
            if stored and time.monotonic() - watched > WATCH_S:
                watched = time.monotonic()
                tell()
        if time.monotonic() - beaten > BEAT_S:
            beaten = time.monotonic()
            store.beat()


def is_complete(source: Source, store: TrialStore) -> bool:
    """Whether every design has its row already."""
    _adopt(source, store)
    return len(store.rows()) >= source.size


def _store_finished(
    pending: dict[Future, Job], pool: WorkerPool, source: Source, store: TrialStore
) -> bool:
    """Store what is finished, after a wait of at most POLL_S; whether anything was.

    No future is referred to afterwards: while one is, Dask makes its result again should the worker die.
    """
    done, _ = wait(pending, timeout=POLL_S, return_when=FIRST_COMPLETED)
    for future in done:
        outcome = _outcome(future, pool)
        store.finish(pending.pop(future), outcome, source.objectives(outcome))
    return bool(done)


def _outcome(future: Future, pool: WorkerPool) -> Outcome:
    try:
        return future.result()
    except pool.lost:
        return Outcome(reason=WORKER_DIED)


def _next(source: Source, store: TrialStore) -> Job | None:
    """The first design that nobody has: a dead process's, else a new one."""
    while True:
        taken = store.by_slot()
        slot = next((s for s in range(source.size) if _is_free(store, taken.get(s, []))), None)
        if slot is None:
            return None
        before = taken.get(slot)
        if not before:
            job = source.claim(store, slot)
        else:
            attempt = max(t.user_attrs[CLAIM]["attempt"] for t in before) + 1
            job = source.again(store, slot, attempt, before[0])
        if job is not None:
            return job


def _is_free(store: TrialStore, trials: list[FrozenTrial]) -> bool:
    """No row, and nobody alive at it."""
    if any(ROW in t.user_attrs for t in trials):
        return False
    return all(t.state.is_finished() or store.gone(t) for t in trials)


def _adopt(source: Source, store: TrialStore) -> None:
    """Close what dead processes left open: with its row where that was stored, else as failed."""
    for trials in store.by_slot().values():
        for trial in trials:
            if trial.state.is_finished() or not store.gone(trial):
                continue
            row = trial.user_attrs.get(ROW)
            values = source.objectives(Outcome(**row)) if row else None
            store.tell(trial.number, values)
