"""Where designs are evaluated: in processes of this machine, or on the cluster of a Dask scheduler."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from flexspline.pipeline.study.local_workers import LocalWorkers, WorkerDiedError
from flexspline.pipeline.study.study import StudyError

CONNECT_S = 30.0
"""[s] distributed's own default."""


@dataclass(frozen=True)
class WorkerPool:
    """Evaluates designs.

    Attributes
    ----------
    executor, width : where designs go, and how many at once.
    lost : errors that mean that a design's workers died.
    """

    executor: Executor
    width: Callable[[], int]
    lost: tuple[type[BaseException], ...] = ()

    def submit(self, function: Callable, *arguments: object) -> Future:
        return self.executor.submit(function, *arguments)


def check_scheduler(address: str) -> None:
    """Check that a scheduler answers, before anything is written.

    Raises
    ------
    StudyError : nobody does.
    """
    with _client_of(address):
        pass


def _client_of(address: str) -> Any:
    import distributed

    Client: Any = distributed.Client  # untyped in a typed package
    try:
        return Client(address, timeout=CONNECT_S)
    except (OSError, ValueError, TimeoutError) as fault:
        reason = f"no Dask scheduler answers there ({fault})"
        raise StudyError("run.scheduler", address, reason) from fault


@contextmanager
def worker_pool(workers: int, scheduler: str) -> Iterator[WorkerPool]:
    """Return local worker processes, one thread each, or a running cluster's workers.

    Raises
    ------
    StudyError : nobody answers at the scheduler's address.
    """
    if not scheduler:
        with LocalWorkers(workers) as executor:
            yield WorkerPool(executor, lambda: workers, (WorkerDiedError,))
        return
    import dask
    from distributed.scheduler import KilledWorker

    settings = {
        "distributed.comm.timeouts.connect": f"{CONNECT_S:g}s",
        "distributed.logging.distributed": "critical",
    }
    with dask.config.set(settings), _client_of(scheduler) as client:
        yield WorkerPool(
            client.get_executor(pure=False, retries=0),
            lambda: max(1, sum(client.nthreads().values())),
            (KilledWorker,),
        )
