"""Drawing in several processes at once, each for one picture at a time."""

from __future__ import annotations

from collections.abc import Callable
from queue import SimpleQueue
from typing import Any

from flexspline.results.renders.process import DrawingProcess


class DrawingPool:
    """`count` drawing processes that threads share; a context that ends them.

    A function on which one of them ended is not tried by another.
    """

    def __init__(self, count: int) -> None:
        self._gave_up: dict[str, str] = {}
        self._every = [DrawingProcess(gave_up=self._gave_up) for _ in range(count)]
        self._free: SimpleQueue[DrawingProcess] = SimpleQueue()

    def __enter__(self) -> DrawingPool:
        for process in self._every:
            self._free.put(process.__enter__())
        return self

    def __exit__(self, *_: object) -> None:
        for process in self._every:
            process.__exit__()

    def draw(self, write: Callable[..., None], *arguments: Any) -> bytes:
        """As `DrawingProcess.draw`, by the next process that is free.

        Raises
        ------
        NotDrawnError
        """
        process = self._free.get()
        try:
            return process.draw(write, *arguments)
        finally:
            self._free.put(process)
