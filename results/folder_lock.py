"""Only one command at a time writes to a folder; studies may share one.

The lock is the kernel's, on the folder itself (flock(2), Linux and macOS): it ends with its process, however
that ends, so none is left over, and it leaves no file.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")
_COMMAND: ContextVar[ExitStack | None] = ContextVar("command", default=None)
"""What the running command holds until it ends."""


@contextmanager
def held_until_the_end() -> Iterator[None]:
    """A command; contexts entered by `hold` are left at its end."""
    with ExitStack() as stack:
        before = _COMMAND.set(stack)
        try:
            yield
        finally:
            _COMMAND.reset(before)


def hold(context: AbstractContextManager[T]) -> T:
    """Enter a context until the command ends; outside a command, until this call does."""
    stack = _COMMAND.get()
    if stack is not None:
        return stack.enter_context(context)
    with context as entered:
        return entered


@contextmanager
def locked(folder: Path, shared: bool = False) -> Iterator[bool]:
    """Lock the folder while the context lasts; yields False if another command has it.

    `shared`: together with others that ask for it. Yields True if the system cannot lock folders.

    Raises
    ------
    OSError : the folder cannot be opened.
    """
    try:
        import fcntl
    except ImportError:  # Windows
        yield True
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        free = True
        try:
            fcntl.flock(handle, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
        except BlockingIOError:
            free = False
        except OSError:  # some network file systems lock no folders
            pass
        yield free
    finally:
        with suppress(OSError):
            fcntl.flock(handle, fcntl.LOCK_UN)  # a child that was forked may hold the handle too
        os.close(handle)
