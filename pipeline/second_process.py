"""Independent tasks in two processes: the second begins as a copy of this one, and sends what it found.

Copying a process costs some milliseconds where starting one that imports as much costs a second.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any, TypeVar

from flexspline.fea.threads import one_thread

T = TypeVar("T")
_ALLOWED = ContextVar("allowed", default=False)


@contextmanager
def second_process() -> Iterator[None]:
    """While open, `results_of` may take a second process, and BLAS takes one thread in each.

    With two threads in each of two processes they wait for each other: 2.8 s in place of 0.4.

    Only where this process has no thread that might hold a lock at that moment: its copy would wait for it
    for ever. A server has such threads, a command has none.
    """
    token = _ALLOWED.set(_can_copy())
    try:
        with one_thread():
            yield
    finally:
        _ALLOWED.reset(token)


def results_of(tasks: Sequence[Callable[[], T]]) -> list[T]:
    """What each task returns, in their order; a task must change nothing that others look at.

    Every other one runs in the second process, if there may be one. Where it fails, whatever the reason, its
    tasks are done here once more, and what they raise then is raised.
    """
    theirs = tasks[1::2]
    if not theirs or not _ALLOWED.get():
        return [task() for task in tasks]
    copying = get_context("fork")
    try:
        here, there = copying.Pipe(duplex=False)
        second = copying.Process(target=_send_results, args=(there, theirs), daemon=True)
        second.start()
    except OSError:  # no process or open file more is allowed, or no memory
        return [task() for task in tasks]
    there.close()
    try:
        mine = [task() for task in tasks[::2]]
        others: list[T] | None = _received(here)
    finally:
        second.kill()
        second.join()
    if others is None:
        others = [task() for task in theirs]
    both = iter(mine), iter(others)
    return [next(both[number % 2]) for number in range(len(tasks))]


def _can_copy() -> bool:
    """On Linux with two processors; macOS has libraries that do not work in a copy."""
    return sys.platform == "linux" and len(os.sched_getaffinity(0)) > 1


def _send_results(to: Connection, tasks: Sequence[Callable[[], T]]) -> None:
    # Ctrl-C reaches both; the first process ends the second
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        to.send([task() for task in tasks])
    except BaseException:
        os._exit(1)  # the first process meets the fault itself


def _received(sent: Connection) -> Any:
    """None where the second process ended without an answer, or in the middle of one."""
    try:
        return sent.recv()
    except Exception:  # what it sent may fail in any way as it is made again
        return None
