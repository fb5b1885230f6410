"""Independent tasks in two processes: the second is a fork of this one, and sends its results back.

Copying a process costs some milliseconds where starting one that imports as much costs a second.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any, Self, TypeVar

import numpy as np

from flexspline.fea.child_python import end_with
from flexspline.fea.process_lock import shared_locks
from flexspline.fea.threads import one_thread

T = TypeVar("T")
_ALLOWED = ContextVar("allowed", default=False)


@contextmanager
def second_process() -> Iterator[None]:
    """While open, `results_of` may take a second process, and OpenBLAS takes one thread in each.

    With two threads in each of two processes they wait for each other: 2.8 s in place of 0.4. oneMKL, loaded
    later, keeps its two: `stiffness` of three examples takes as long with one.

    Only where this process has no thread that might hold a lock at that moment: its copy would wait for it
    for ever. A server has such threads, a command has none.
    """
    token = _ALLOWED.set(_can_copy())
    try:
        with one_thread():
            yield
    finally:
        _ALLOWED.reset(token)


def may_copy() -> bool:
    """Whether `results_of` may take a second process."""
    return _ALLOWED.get()


def results_of(
    tasks: Sequence[Callable[[], T]], begun: Callable[[], None] = lambda: None
) -> list[T]:
    """What each task returns, in their order; a task must change nothing that others look at.

    A second process takes those not yet begun, if there may be one. Where it fails, whatever the reason, its
    tasks are done here once more, and what they raise then is raised. `begun` is called here after it began,
    and may start threads: the copy is made.
    """
    if len(tasks) < 2 or not may_copy():
        begun()
        return [task() for task in tasks]
    copying = get_context("fork")
    with ExitStack() as open_files:
        try:
            numbers = open_files.enter_context(_TaskNumbers(len(tasks)))
            open_files.enter_context(shared_locks())
            here, there = copying.Pipe(duplex=False)
            second = copying.Process(
                target=_send_results, args=(there, numbers, tasks, os.getpid()), daemon=True
            )
            second.start()
        except OSError:  # no process or open file more is allowed, or no memory
            begun()
            return [task() for task in tasks]
        there.close()
        try:
            begun()
            done = _work(numbers, tasks)
            done |= _received(here)
        finally:
            second.kill()
            second.join()
        return [done[n] if n in done else task() for n, task in enumerate(tasks)]


class _TaskNumbers:
    """Of the tasks not yet begun, in a pipe: each is read once, by the process that comes first."""

    def __init__(self, count: int) -> None:
        self._read, write = os.pipe()
        with os.fdopen(write, "wb") as to:
            to.write(np.arange(count, dtype=np.int32).tobytes())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._read)

    def __iter__(self) -> Iterator[int]:
        while number := os.read(self._read, np.dtype(np.int32).itemsize):
            yield int(np.frombuffer(number, np.int32)[0])


def _can_copy() -> bool:
    """On Linux with two processors, where what a copy says goes where this process's words go; macOS has
    libraries that do not work in a copy."""
    if sys.platform != "linux" or len(os.sched_getaffinity(0)) < 2:
        return False
    try:
        sys.stderr.fileno()
    except (AttributeError, OSError, ValueError):  # None, or text kept in memory
        return False
    return True


def _work(numbers: Iterable[int], tasks: Sequence[Callable[[], T]]) -> dict[int, T]:
    """What the tasks return that nobody has begun, by their number."""
    return {number: tasks[number]() for number in numbers}


def _send_results(
    to: Connection, numbers: Iterable[int], tasks: Sequence[Callable[[], T]], parent: int
) -> None:
    # Ctrl-C reaches both; the first process ends the second
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        end_with(parent)
        to.send(_work(numbers, tasks))
    except BaseException:
        os._exit(1)  # the first process meets the fault itself


def _received(sent: Connection) -> dict[int, Any]:
    """Nothing where the second process ended without an answer, or in the middle of one."""
    try:
        received: dict[int, Any] = sent.recv()
    except Exception:  # what it sent may fail in any way as it is made again
        return {}
    return received
