"""Results that are computed once for each history, fit or other value, and needed repeatedly."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import update_wrapper
from typing import Any, Generic, Protocol, TypeVar, TypeVarTuple

import numpy as np


class HasMemo(Protocol):
    """A value that never changes, and keeps what was computed from it."""

    @property
    def memo(self) -> dict[tuple[Hashable, ...], Any]: ...


Value = TypeVar("Value", bound=HasMemo)
Numbers = TypeVarTuple("Numbers")
T = TypeVar("T")


class once(Generic[Value, *Numbers, T]):
    """A function whose answer for a value, and for the numbers given beside it, stays in its `memo`.

    A kept array is read-only, because the next caller gets the same one.
    """

    def __init__(self, find: Callable[[Value, *Numbers], T]) -> None:
        update_wrapper(self, find)
        self._find = find
        self._name = f"{find.__module__}.{find.__qualname__}"

    def __call__(self, value: Value, *numbers: *Numbers) -> T:
        key = self._key(numbers)
        if key not in value.memo:
            self.keep(value, self._find(value, *numbers), *numbers)
        kept: T = value.memo[key]
        return kept

    def keep(self, value: Value, answer: T, *numbers: *Numbers) -> None:
        """Stores a known result: a history made from another one has that one's results."""
        if isinstance(answer, np.ndarray):
            answer.setflags(write=False)
        value.memo[self._key(numbers)] = answer

    def _key(self, numbers: tuple[Hashable, ...]) -> tuple[Hashable, ...]:
        return self._name, *numbers
