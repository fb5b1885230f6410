"""Turns that are taken one after the other, by threads and by the copies that a process makes of itself."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from threading import RLock

_FILES: list[int] = []
"""File descriptor of the file on which processes lock a turn's place, where turns are shared."""


@contextmanager
def shared_turns() -> Iterator[None]:
    """While open, turns are shared with copies of this process that are made meanwhile.

    By locks on places of a file, which the system takes from a process that ends.

    Raises
    ------
    OSError : no file more is allowed.
    """
    with tempfile.TemporaryFile() as file:
        _FILES.append(file.fileno())
        try:
            yield
        finally:
            _FILES.pop()


class Turn(AbstractContextManager[None]):
    """Of one thread and one process at a time, which may take it again within. `place`: its own, from 0."""

    def __init__(self, place: int) -> None:
        self._place = place
        self._lock, self._inside = RLock(), 0

    def __enter__(self) -> None:
        self._lock.acquire()
        try:
            if not self._inside:
                self._of_process(True)
        except BaseException:  # interrupted while it waited for another process
            self._lock.release()
            raise
        self._inside += 1

    def __exit__(self, *_: object) -> None:
        self._inside -= 1
        if not self._inside:
            self._of_process(False)
        self._lock.release()

    def _of_process(self, taken: bool) -> None:
        for file in _FILES[-1:]:
            import fcntl  # Windows has none, and no copies of processes

            fcntl.lockf(file, fcntl.LOCK_EX if taken else fcntl.LOCK_UN, 1, self._place)
