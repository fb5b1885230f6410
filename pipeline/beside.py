"""Work that goes on beside other work, on another core: factorising lets go of Python's interpreter."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import TypeVar

from flexspline.pipeline.progress import Progress

T = TypeVar("T")


@contextmanager
def beside(progress: Progress, work: Callable[[], T]) -> Iterator[Future[T]]:
    """Do `work` in a thread while the context is open; its result is the future's.

    Where the context ends by an error or an interruption, the work ends at its next stage.
    """
    try:
        with ThreadPoolExecutor(1) as thread:
            try:
                yield thread.submit(work)
            except BaseException:
                progress.stopped = True
                raise
    finally:
        progress.stopped = False
