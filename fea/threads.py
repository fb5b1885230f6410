"""How many threads the linear algebra libraries use."""

from __future__ import annotations

from contextlib import AbstractContextManager


def one_thread() -> AbstractContextManager[object]:
    """One thread for BLAS while the context is open.

    For many small dense matrices: threads of OpenBLAS wait for each other in a loop that keeps a core busy.
    Lift-off of one cup, 608 and 864 unknowns, beside two other computing programs on two cores: 1.0 to 1.3 s
    with one thread, 4.1 to 7.0 s with two; the processor time is 0.6 s and 3.8 to 6.9 s.
    """
    from threadpoolctl import threadpool_limits

    return threadpool_limits(1, "blas")
