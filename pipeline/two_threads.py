"""Work shared by two threads, each on its core: factorisation releases Python's interpreter lock."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import TypeVar

from flexspline.pipeline.progress import Progress

T = TypeVar("T")


@contextmanager
def beside(progress: Progress, tasks: Sequence[Callable[[], T]]) -> Iterator[Callable[[], list[T]]]:
    """Begin `tasks` in a thread, one after the other; the function that is given does those not yet begun.

    It returns all results in the tasks' order, or raises what a task raised, after which none is begun. Where
    the context ends by an error or an interruption, the thread ends at its next stage.
    """
    numbers = iter(range(len(tasks)))  # of the tasks not yet begun, for both threads
    results: dict[int, T] = {}
    stopped = progress.stopped

    def work() -> None:
        for number in numbers:
            try:
                results[number] = tasks[number]()
            except BaseException:
                deque(numbers, maxlen=0)
                raise

    try:
        with ThreadPoolExecutor(1) as executor:
            try:
                other = executor.submit(work)

                def rest() -> list[T]:
                    work()
                    other.result()
                    return [results[number] for number in range(len(tasks))]

                yield rest
            except BaseException:
                progress.stopped = True
                raise
    finally:
        progress.stopped = stopped
