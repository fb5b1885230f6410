"""Locks between threads and forked processes."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from functools import cache
from pathlib import Path
from threading import RLock

_FOLDERS: list[Path] = []
"""The last one is shared with copies of this process, whose locks are on places of one file."""


@contextmanager
def shared_locks() -> Iterator[None]:
    """While open, locks are shared with copies of this process that are made meanwhile, and so is a folder.

    They are on places of a file in memory; the system takes them from a process that ends.

    Raises
    ------
    OSError : no file or folder more is allowed.
    """
    _file()
    folder = Path(tempfile.mkdtemp(prefix="flexspline-shared-"))
    _FOLDERS.append(folder)
    try:
        yield
    finally:
        _FOLDERS.pop()
        shutil.rmtree(folder, ignore_errors=True)


def shared_folder() -> Path | None:
    """Where copies of this process find what one of them made; None where locks are not shared."""
    return _FOLDERS[-1] if _FOLDERS else None


@cache
def _file() -> int:
    """Descriptor of the file, which stays open: closing it would end every lock of this process."""
    return os.memfd_create("locks")  # of Linux, as copies of processes are


class ProcessLock(AbstractContextManager[None]):
    """A lock of one thread in one process, which may take it again. `place` [from 0] is its own."""

    def __init__(self, place: int) -> None:
        self._place = place
        self._lock, self._inside, self._of_process = RLock(), 0, False

    def __enter__(self) -> None:
        self._lock.acquire()
        try:
            if not self._inside and _FOLDERS:
                import fcntl  # Windows has none

                fcntl.lockf(_file(), fcntl.LOCK_EX, 1, self._place)
                self._of_process = True
        except BaseException:  # interrupted while it waited for another process
            self._lock.release()
            raise
        self._inside += 1

    def __exit__(self, *_: object) -> None:
        self._inside -= 1
        try:
            if not self._inside and self._of_process:
                import fcntl

                self._of_process = False
                fcntl.lockf(_file(), fcntl.LOCK_UN, 1, self._place)
        finally:
            self._lock.release()
