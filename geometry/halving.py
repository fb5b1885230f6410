"""Finds the end of a range by halving."""

from __future__ import annotations

from collections.abc import Callable


def last_that(holds: Callable[[float], bool], inside: float, outside: float, width: float) -> float:
    """The value farthest from `inside` towards `outside` for which a condition holds, to within `width`.

    It holds at `inside`, not at `outside`, and changes once between them.
    """
    while abs(outside - inside) > width:
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if holds(middle) else (inside, middle)
    return inside
