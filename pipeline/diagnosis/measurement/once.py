"""What is found once for each history, and needed again and again."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Concatenate, ParamSpec, TypeVar

from flexspline.pipeline.diagnosis.measurement.history import History

P = ParamSpec("P")
T = TypeVar("T")


def once(find: Callable[Concatenate[History, P], T]) -> Callable[Concatenate[History, P], T]:
    """`find`, whose answer for a history, and for the numbers given beside it, stays in its `memo`."""
    name = f"{find.__module__}.{find.__qualname__}"

    @wraps(find)
    def found(history: History, /, *numbers: P.args, **named: P.kwargs) -> T:
        key = (name, *numbers, *sorted(named.items()))
        if key not in history.memo:
            history.memo[key] = find(history, *numbers, **named)
        answer: T = history.memo[key]
        return answer

    return found
