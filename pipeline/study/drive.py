"""The loop of a study: claim a design, evaluate it, store its row; until all are done."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from typing import Protocol

from flexspline.pipeline.study.claims import Row, Try
from flexspline.pipeline.study.cluster import WorkerPool
from flexspline.pipeline.study.evaluate import Outcome, Task
from flexspline.pipeline.study.local_workers import WORKER_DIED
from flexspline.pipeline.study.store import BEAT_S, Finished, TrialStore

POLL_S = 1.0
"""How long to wait for a result before looking after the rest."""
WATCH_S = 0.5
"""Between two words of progress, …"""
WATCH_SHARE = 0.05
"""… which look at all rows: no more than this share of the time goes to them, however many there are."""


class Source(Protocol):
    """A source of designs, and what their objectives are."""

    @property
    def size(self) -> int:
        """Number of designs that the study wants."""

    def ahead(self, width: int) -> int:
        """Return how many designs wait for `width` workers, so that none is idle between two designs."""

    def claim(self, store: TrialStore, count: int) -> list[Try]:
        """Claim at most `count` designs that nobody has, at least one where there is one."""

    def store(self, store: TrialStore, finished: Sequence[Finished]) -> None:
        """Store the outcomes of designs."""

    def task(self, values: Mapping[str, float]) -> Task:
        """Return the task for a worker."""

    def objectives(self, outcome: Outcome) -> list[float] | None:
        """Return the objectives for Optuna; None for a design that has no figures."""


@dataclass(frozen=True)
class StudyProgress:
    """The state of a study: all rows, how many came since `seconds` ago, how many are wanted.

    Rows of other processes that share the study count too: they shorten the time that is left.
    """

    rows: list[Row]
    fresh: int
    seconds: float
    size: int


@dataclass(frozen=True)
class StudyListener:
    """Hears of a study: `watch` is given its progress, `say` a line on other work than its designs."""

    watch: Callable[[StudyProgress], None] = lambda progress: None
    say: Callable[[str], None] = lambda line: None


NOBODY = StudyListener()


def evaluate_all(
    source: Source,
    store: TrialStore,
    pool: WorkerPool,
    evaluate: Callable[[Task], Outcome],
    watch: Callable[[StudyProgress], None],
) -> list[Row]:
    """Evaluate until every design has a row, whoever made it; return the rows by slot.

    `watch` hears of finished designs at most every WATCH_S, of what other processes do while it
    waits for them, and of the end. An error that is not ours ends the study: what is finished is stored.
    """
    began = beaten = time.monotonic()
    next_word = began + WATCH_S
    pending: dict[Future, Try] = {}
    _adopt(source, store)
    before = len(within(store.rows(), source.size))

    def tell() -> list[Row]:
        rows = list(within(store.rows(), source.size))
        watch(StudyProgress(rows, len(rows) - before, time.monotonic() - began, source.size))
        return rows

    try:
        store.beat()
        while True:
            _give_out(pending, pool, evaluate, source, store)
            if not pending:
                rows = tell()
                if len(rows) >= source.size:
                    return rows
                time.sleep(POLL_S)  # another process has the rest; should it die, they come to us
                _adopt(source, store)
            elif _store_finished(pending, pool, source, store):
                started = time.monotonic()
                if started > next_word:
                    tell()
                    ended = time.monotonic()
                    next_word = ended + max(WATCH_S, (ended - started) / WATCH_SHARE)
            if time.monotonic() - beaten > BEAT_S:
                beaten = time.monotonic()
                store.beat()
    # a notebook's process lives on, and nobody else would take these for free
    except BaseException:
        store.release()
        raise


def is_complete(source: Source, store: TrialStore) -> bool:
    """Whether every design has its row already."""
    _adopt(source, store)
    return len(within(store.rows(), source.size)) >= source.size


def within(rows: Sequence[Row], size: int) -> tuple[Row, ...]:
    """Return the rows of a study of that size: an earlier, longer one may have left others."""
    return tuple(row for row in rows if row.slot < size)


def _give_out(
    pending: dict[Future, Try],
    pool: WorkerPool,
    evaluate: Callable[[Task], Outcome],
    source: Source,
    store: TrialStore,
) -> None:
    """Have as many designs at work and waiting as the workers want, as far as there are any."""
    width = pool.width()
    while (lack := width + source.ahead(width) - len(pending)) > 0:
        jobs = source.claim(store, lack)
        for job in jobs:
            pending[pool.submit(evaluate, source.task(job.values))] = job
        if not jobs:
            return


def _store_finished(
    pending: dict[Future, Try], pool: WorkerPool, source: Source, store: TrialStore
) -> bool:
    """Store what is finished, after a wait of at most POLL_S; whether anything was.

    No future is referred to afterwards: while one is, Dask makes its result again should the worker die.
    """
    done, _ = wait(pending, timeout=POLL_S, return_when=FIRST_COMPLETED)
    finished = []
    for future in done:
        outcome = _outcome(future, pool)
        finished.append(Finished(pending.pop(future), outcome, source.objectives(outcome)))
    if finished:
        source.store(store, finished)
    return bool(finished)


def _outcome(future: Future, pool: WorkerPool) -> Outcome:
    try:
        return future.result()
    except pool.lost:
        return Outcome(faults=(WORKER_DIED,))


def _adopt(source: Source, store: TrialStore) -> None:
    """Close what dead processes left open: with its row where that was stored, else as failed."""
    known = store.refresh()
    dead = store.dead()
    for left in [t for t in known.open() if t.claim.owner in dead]:
        store.tell(left.number, source.objectives(left.outcome) if left.outcome else None)
