"""Worker processes of this machine, each connected by its own pipe: none of them opens a port.

A process pool of the standard library is lost as a whole when one process dies, and Dask's local cluster
listens on the loopback, where every user of the machine reaches it.
"""

from __future__ import annotations

import os
import pickle
import queue
import subprocess
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextlib import suppress
from functools import partial
from typing import Any, cast

from flexspline.fea.child_python import child_command
from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.study.worker import READY, read_frame, write_frame

RETRIES = 2
"""A design whose worker dies is tried again so many times."""
WORKER_DIED = f"its worker died {RETRIES + 1} times"
ENVIRONMENT = {
    "OMP_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MALLOC_TRIM_THRESHOLD_": str(2**30),
    "MALLOC_MMAP_THRESHOLD_": str(2**30),
}
"""One thread per worker; and glibc keeps freed memory, since giving arrays of some hundred kB back to the
system after every use made a design take 0.54 s instead of 0.38 s."""


class WorkerDiedError(ComputationError):
    """A design's worker died at every try."""


class WorkerStartError(ComputationError):
    """A worker process ended before it could take work."""


class LocalWorkers(Executor):
    """`count` processes, each started with its first call and again where it died.

    Leaving the context ends them at once, whatever they are at. In sessions of their own they do not see
    the Ctrl-C that a terminal sends; they end with this process too, however that ends.
    """

    def __init__(self, count: int) -> None:
        self._calls: queue.SimpleQueue[tuple[Future[Any], bytes] | None] = queue.SimpleQueue()
        self._workers = [_WorkerProcess() for _ in range(count)]
        self._threads = [
            threading.Thread(target=self._feed, args=(w,), daemon=True) for w in self._workers
        ]
        for thread in self._threads:
            thread.start()

    def submit(self, fn: Callable, /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Return the future of `fn(*args, **kwargs)`; `fn` must be importable by its name."""
        future: Future[Any] = Future()
        self._calls.put((future, pickle.dumps((partial(fn, **kwargs), args))))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = True) -> None:
        """End the processes now; calls without an answer are cancelled or fail."""
        for worker in self._workers:
            worker.close()
        with suppress(queue.Empty):
            while call := self._calls.get_nowait():
                call[0].cancel()
        for _ in self._threads:
            self._calls.put(None)
        if wait:
            for thread in self._threads:
                thread.join()

    def _feed(self, worker: _WorkerProcess) -> None:
        while call := self._calls.get():
            future, frame = call
            if future.set_running_or_notify_cancel():
                try:
                    good, value = pickle.loads(worker.answer(frame))
                except Exception as fault:
                    good, value = False, fault
                (future.set_result if good else future.set_exception)(value)
                del value
            del call, future, frame  # or they live until the next call
        worker.end()


class _WorkerProcess:
    """One process at the end of a pipe; another in its place where it died."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._closed, self._lock = False, threading.Lock()

    def answer(self, call: bytes) -> bytes:
        """What the process says to a call, tried again where the process dies of it.

        Raises
        ------
        WorkerDiedError, WorkerStartError
        OSError : the system starts no process.
        """
        for _ in range(RETRIES + 1):
            calls, answers = self._pipes()
            with suppress(OSError):  # nobody reads any more
                write_frame(calls, call)
                if (reply := read_frame(answers)) is not None:
                    return reply
            self.end()
        raise WorkerDiedError(WORKER_DIED)

    def close(self) -> None:
        """End the process now, and start no other."""
        with self._lock:
            self._closed = True
            if self._process:
                self._process.kill()

    def _pipes(self) -> tuple[Any, Any]:
        """Of the process, started if there is none that lives."""
        if self._process is None or self._process.poll() is not None:
            self.end()
            with self._lock:
                if self._closed:
                    raise WorkerStartError("the workers are closed")
                self._process = _started()
            if read_frame(cast(Any, self._process.stdout)) != READY:
                status = self.end()
                raise WorkerStartError(
                    f"a worker process ended as it started, with status {status}"
                )
        return self._process.stdin, self._process.stdout

    def end(self) -> int | None:
        """Take leave of the process; its exit status."""
        process, self._process = self._process, None
        if process is None:
            return None
        process.kill()
        with suppress(OSError), process:  # closes its pipes and waits; what it left unread is lost
            pass
        return process.returncode


def _started() -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        child_command("flexspline.pipeline.study.worker", "serve"),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={**os.environ, **ENVIRONMENT},
        start_new_session=True,
        creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),  # Windows
    )
