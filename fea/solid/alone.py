"""Only one large solid model is solved at a time, to limit memory."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from flexspline.fea.process_lock import ProcessLock

LARGE = 30_000
"""A model of this many elements is large: 135 000 unknowns, 0.3 GB of matrix and 0.3 GB of iteration, or 0.5
GB of factors in single precision. With factors in double, one command took 2.45 GB when models of 30 688 and
35 016 elements were solved at once."""
_LOCK = ProcessLock(0)
"""Place in the file of locks. The cache uses the places from 1 on (`pipeline/cache.py`)."""


@contextmanager
def alone(elements: int) -> Iterator[None]:
    """Only one thread at a time, in this process and its copies, enters this context with a model of LARGE
    elements or more."""
    if elements < LARGE:
        yield
        return
    with _LOCK:
        yield
