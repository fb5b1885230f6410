"""Only one large solid model is solved at a time, to limit memory."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from flexspline.fea.process_lock import ProcessLock

LARGE = 30_000
"""Elements: 135 000 unknowns, 0.3 GB of matrix and 0.3 GB of iteration, or 0.5 GB of factors in single
precision. Two of 30 688 and 35 016 at once made 2.45 GB of a command with factors in double."""
_LOCK = ProcessLock(0)
"""Place 0 of the locks, which is its own: the cache takes those from 1 on (`pipeline/cache.py`)."""


@contextmanager
def alone(elements: int) -> Iterator[None]:
    """While the context lasts no other thread, and no copy of this process, is in one for a model of LARGE
    elements or more."""
    if elements < LARGE:
        yield
        return
    with _LOCK:
        yield
