"""Results that are computed once for each history and needed repeatedly."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import update_wrapper
from typing import Generic, TypeVar, TypeVarTuple

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History

Numbers = TypeVarTuple("Numbers")
T = TypeVar("T")


class once(Generic[*Numbers, T]):
    """A function whose answer for a history, and for the numbers given beside it, stays in its `memo`.

    A kept array is read-only, because the next caller gets the same one.
    """

    def __init__(self, find: Callable[[History, *Numbers], T]) -> None:
        update_wrapper(self, find)
        self._find = find
        self._name = f"{find.__module__}.{find.__qualname__}"

    def __call__(self, history: History, *numbers: *Numbers) -> T:
        key = self._key(numbers)
        if key not in history.memo:
            self.keep(history, self._find(history, *numbers), *numbers)
        kept: T = history.memo[key]
        return kept

    def keep(self, history: History, answer: T, *numbers: *Numbers) -> None:
        """Stores a known result: a history made from another one has that one's results."""
        if isinstance(answer, np.ndarray):
            answer.setflags(write=False)
        history.memo[self._key(numbers)] = answer

    def _key(self, numbers: tuple[Hashable, ...]) -> tuple[Hashable, ...]:
        return self._name, *numbers
