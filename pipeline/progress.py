"""Stages as they pass: a line each for the person who waits, and the seconds that each took itself."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager


class Progress:
    """Times nested stages; `seconds` holds each stage's own time, inner stages not counted twice."""

    def __init__(self, say: Callable[[str], None] = lambda line: None) -> None:
        self._say = say
        self._start = time.monotonic()
        self._inner: list[float] = []
        self.seconds: dict[str, float] = {}

    def note(self, text: str) -> None:
        """One line with the time since the start."""
        self._say(f"[{time.monotonic() - self._start:6.1f} s] {text}")

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Announce a stage and add up its time."""
        self.note(name)
        began = time.monotonic()
        self._inner.append(0.0)
        try:
            yield
        finally:
            whole = time.monotonic() - began
            own = whole - self._inner.pop()
            self.seconds[name] = self.seconds.get(name, 0.0) + own
            if self._inner:
                self._inner[-1] += whole
