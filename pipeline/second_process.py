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
from threading import Thread
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
    later, keeps its two for large solid meshes.

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
    tasks: Sequence[Callable[[], T]],
    begun: Callable[[], None] = lambda: None,
    on_result: Callable[[int, T], None] = lambda number, result: None,
) -> list[T]:
    """Return the result of each task, in order; a task must change nothing that others look at.

    A second process takes those not yet begun, if there may be one. Where it fails, whatever the reason, its
    tasks are done here once more, and what they raise then is raised. `begun` is called here after it began,
    and may start threads: the copy is made. `on_result` is given each task's number and result as it is
    there, by one of two threads.
    """
    if len(tasks) < 2 or not may_copy():
        begun()
        return [*_done_here(tasks, range(len(tasks)), on_result).values()]
    copying = get_context("fork")
    with ExitStack() as open_files:
        try:
            numbers = open_files.enter_context(_TaskNumbers(len(tasks)))
            open_files.enter_context(shared_locks())
            receiving, sending = copying.Pipe(duplex=False)
            second = copying.Process(
                target=_send_results, args=(sending, numbers, tasks, os.getpid()), daemon=True
            )
            second.start()
        except OSError:  # no process or open file more is allowed, or no memory
            begun()
            return [*_done_here(tasks, range(len(tasks)), on_result).values()]
        sending.close()
        try:
            begun()
            received = _Received(receiving, on_result)
            done = _done_here(tasks, numbers, on_result)
            done |= received.all()
        finally:
            second.kill()
            second.join()
        left = [n for n in range(len(tasks)) if n not in done]
        done |= _done_here(tasks, left, on_result)
        return [done[n] for n in range(len(tasks))]


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


def _done_here(
    tasks: Sequence[Callable[[], T]], numbers: Iterable[int], on_result: Callable[[int, T], None]
) -> dict[int, T]:
    """What tasks return, by their number."""
    done: dict[int, T] = {}
    for number in numbers:
        done[number] = tasks[number]()
        on_result(number, done[number])
    return done


def _send_results(
    to: Connection, numbers: Iterable[int], tasks: Sequence[Callable[[], T]], parent: int
) -> None:
    # Ctrl-C reaches both; the first process ends the second
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        end_with(parent)
        for number in numbers:
            to.send((number, tasks[number]()))
    except BaseException:
        os._exit(1)  # the first process meets the fault itself


class _Received:
    """What the second process sends, told as it comes by a thread of its own."""

    def __init__(self, sent: Connection, on_result: Callable[[int, Any], None]) -> None:
        self._sent, self._on_result = sent, on_result
        self._done: dict[int, Any] = {}
        self._fault: BaseException | None = None
        self._thread = Thread(target=self._receive, daemon=True)
        self._thread.start()

    def all(self) -> dict[int, Any]:
        """Waits for the second process's end; raises what `on_result` raised."""
        self._thread.join()
        if self._fault is not None:
            raise self._fault
        return self._done

    def _receive(self) -> None:
        while True:
            try:
                number, result = self._sent.recv()
            except Exception:  # its end; or what it sent, whole or not, fails as it is made again
                return
            self._done[number] = result
            try:
                self._on_result(number, result)
            except BaseException as fault:
                self._fault = fault
                return
