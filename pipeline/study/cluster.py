"""Where evaluations run: local Dask processes, or the cluster of a scheduler."""

from __future__ import annotations

import logging
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from geometry.errors import ComputationError
from pipeline.study.load import StudyError

RETRIES = 2
"""A design whose worker dies is tried again so many times."""
WORKER_DIED = f"its worker died {RETRIES + 1} times"
CONNECT_S = 30.0
WORKER_ENVIRONMENT = {
    "OMP_NUM_THREADS": 1,
    "MKL_NUM_THREADS": 1,
    "OPENBLAS_NUM_THREADS": 1,
    "MALLOC_TRIM_THRESHOLD_": 2**30,
    "MALLOC_MMAP_THRESHOLD_": 2**30,
}
"""One thread per worker; and glibc keeps freed memory, since giving arrays of some hundred kB back to the
system after every use (Dask's choice) made a design take 0.54 s instead of 0.38 s."""


class ClusterError(ComputationError):
    """The cluster went away."""


@dataclass(frozen=True)
class Hands:
    """Who evaluates.

    Attributes
    ----------
    executor, width : where designs go, and how many at once.
    lost : errors that mean that a design's workers died.
    replace_lost : to be called every second or so, lest dead workers stay away.
    """

    executor: Executor
    width: Callable[[], int]
    lost: tuple[type[BaseException], ...] = ()
    replace_lost: Callable[[], None] = lambda: None

    def submit(self, function: Callable, *arguments: object) -> Future:
        return self.executor.submit(function, *arguments)


def check_scheduler(address: str) -> None:
    """See that a scheduler answers, before anything is written.

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
def dask_hands(workers: int, scheduler: str) -> Iterator[Hands]:
    """Local worker processes, one thread each, or a running cluster's workers.

    Raises
    ------
    StudyError : nobody answers at the scheduler's address.
    ClusterError : it went away meanwhile.
    """
    import dask
    import distributed
    from distributed.comm import CommClosedError
    from distributed.scheduler import KilledWorker

    Client: Any = distributed.Client  # untyped in a typed package
    LocalCluster: Any = distributed.LocalCluster

    settings = {
        "distributed.scheduler.allowed-failures": RETRIES,
        # a design that waits does so at the scheduler: on a worker it would share the blame for its death
        "distributed.scheduler.worker-saturation": 1.0,
        "distributed.comm.timeouts.connect": f"{CONNECT_S:g}s",
        "distributed.worker.daemon": True,
        "distributed.admin.tick.limit": "60s",
        "distributed.logging.distributed": "critical",
        "distributed.nanny.pre-spawn-environ": WORKER_ENVIRONMENT,
    }
    with dask.config.set(settings):
        if scheduler:
            with _client_of(scheduler) as client:
                yield Hands(
                    client.get_executor(pure=False, retries=0),
                    lambda: max(1, sum(client.nthreads().values())),
                    (KilledWorker,),
                )
            return
        # where a worker that was to replace a dead one dies too, this one prints a traceback
        logging.getLogger("tornado.application").setLevel(logging.CRITICAL)
        with _deaf_to_interrupts():
            cluster = LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                dashboard_address="127.0.0.1:0",
                memory_limit=0,
                silence_logs=logging.CRITICAL,
            )
        with cluster, Client(cluster) as client:
            try:
                yield Hands(
                    client.get_executor(pure=False),
                    lambda: workers,
                    (KilledWorker,),
                    # to its nanny, a worker that dies in its first moments is one that cannot start; the
                    # cluster gives both up after 15 s (lost-worker-timeout), and asked again starts others
                    lambda: cluster.scale(workers),
                )
            except CommClosedError as fault:
                raise ClusterError(f"the local cluster went away: {fault}") from fault


@contextmanager
def _deaf_to_interrupts() -> Iterator[None]:
    """Processes started within ignore Ctrl-C, which a terminal sends to them too: we close them."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread may set handlers, and only it is interrupted
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
