"""Progress of the stages: one line each, and the seconds that each stage took."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import local


class Stopped(BaseException):
    """Nobody waits for this work any more: an interruption and no error, as KeyboardInterrupt."""


class _OpenStages(local):
    """The seconds of inner stages, of each stage that is open in this thread."""

    def __init__(self) -> None:
        self.inner: list[float] = []


class Progress:
    """Times nested stages; `seconds` holds each stage's own time, inner stages not counted twice.

    Threads may share it; each has stages of its own names.
    """

    def __init__(self, say: Callable[[str], None] = lambda line: None) -> None:
        self._say = say
        self._start = time.monotonic()
        self._open = _OpenStages()
        self.stopped = False
        """Whether all work is to end at its next stage or line."""
        self.seconds: dict[str, float] = {}

    def note(self, text: str) -> None:
        """Write one line with the time since the start.

        Raises
        ------
        Stopped : it is `stopped`.
        """
        if self.stopped:
            raise Stopped
        self._say(f"[{time.monotonic() - self._start:6.1f} s] {text}")

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Announce a stage and add up its time; errors as `note`."""
        self.note(name)
        began = time.monotonic()
        inner = self._open.inner
        inner.append(0.0)
        try:
            yield
        finally:
            whole = time.monotonic() - began
            seconds = whole - inner.pop()
            self.add(name, seconds)
            if inner:
                inner[-1] += whole

    def add(self, name: str, seconds: float) -> None:
        """Add a stage's own time, such as of another process."""
        self.seconds[name] = self.seconds.get(name, 0.0) + seconds
