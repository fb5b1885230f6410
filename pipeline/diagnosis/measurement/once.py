"""What is found once for each history, and needed again and again."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar, TypeVarTuple

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History

Numbers = TypeVarTuple("Numbers")
T = TypeVar("T")


def once(find: Callable[[History, *Numbers], T]) -> Callable[[History, *Numbers], T]:
    """`find`, whose answer for a history, and for the numbers given beside it, stays in its `memo`.

    An array that is kept cannot be written to: the next to ask gets the same one.
    """
    name = f"{find.__module__}.{find.__qualname__}"

    @wraps(find)
    def found(history: History, *numbers: *Numbers) -> T:
        key = (name, *numbers)
        if key not in history.memo:
            answer = find(history, *numbers)
            if isinstance(answer, np.ndarray):
                answer.setflags(write=False)
            history.memo[key] = answer
        kept: T = history.memo[key]
        return kept

    return found
