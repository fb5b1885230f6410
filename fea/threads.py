"""How many threads the linear algebra libraries use."""

from __future__ import annotations

from contextlib import AbstractContextManager
from threading import Lock


class _OneThread(AbstractContextManager[None]):
    """The limit is the whole process's: the first thread sets it, the last one that leaves takes it off."""

    def __init__(self) -> None:
        self._lock, self._inside = Lock(), 0

    def __enter__(self) -> None:
        from threadpoolctl import threadpool_limits

        with self._lock:
            self._inside += 1
            if self._inside == 1:
                self._limits = threadpool_limits(1, "blas")

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._inside -= 1
            if self._inside == 0:
                self._limits.restore_original_limits()


_ONE = _OneThread()


def one_thread() -> AbstractContextManager[None]:
    """One thread for BLAS while the context is open.

    For many small dense matrices: threads of OpenBLAS wait for each other in a loop that keeps a core busy.
    Lift-off of one cup, 608 and 864 unknowns, beside two other computing programs on two cores: 1.0 to 1.3 s
    with one thread, 4.1 to 7.0 s with two; the processor time is 0.6 s and 3.8 to 6.9 s.
    """
    return _ONE
