"""One thread of the linear algebra libraries, asked for by two threads that overlap."""

from __future__ import annotations

import numpy  # noqa: F401  # a library to limit, whatever ran before
from threadpoolctl import threadpool_info, threadpool_limits

from flexspline.fea.threads import one_thread


def threads() -> dict[str, int]:
    """Of each library that this process has loaded."""
    found = (each for each in threadpool_info() if each["user_api"] == "blas")
    return {each["filepath"]: each["num_threads"] for each in found}


def test_the_last_to_leave_takes_the_limit_off() -> None:
    """Neither is inside the other: the first leaves while the second is there."""
    with threadpool_limits(2, "blas"):
        before = threads()
        assert 2 in before.values()  # not in all: one that was loaded for a single thread keeps it
        first, second = one_thread(), one_thread()
        first.__enter__()
        second.__enter__()
        first.__exit__(None, None, None)
        assert set(threads().values()) == {1}
        second.__exit__(None, None, None)
        assert threads() == before
