"""Ranges as error messages print them: rounded inwards, so that each printed end is accepted as input."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal

from flexspline.geometry.listed import joined
from flexspline.geometry.ranges import LENGTH_mm

GAP_mm = 1e-6
"""Gaps below this [mm] close in the CAD kernel (its tolerance is 1e-7 mm)."""
DIGITS, MOST_DIGITS = 6, 17
"""As many as read well; as many as tell any two doubles apart."""
Interval = tuple[float, float]


def upto(limit: float) -> float:
    """The largest length to name where `limit` [mm] is allowed: the check lets `GAP_mm` pass."""
    return limit + GAP_mm / 2


def below(limit: float) -> float:
    """The largest length to name where `limit` [mm] is not allowed."""
    return limit - 2 * GAP_mm


def above(limit: float) -> float:
    """The smallest length to name where `limit` [mm] is not allowed."""
    return limit + 2 * GAP_mm


def is_step(height: float) -> bool:
    """No step, or one that the CAD kernel sees [mm]."""
    return height == 0 or height >= LENGTH_mm.low - 1e-9  # rounding of a difference of lengths


def step_up(level: float, step: float = LENGTH_mm.low) -> float:
    """The smallest length [mm] that is a step above another."""
    return level + step - 5e-10  # half of what `is_step` lets pass


def step_down(level: float, step: float = LENGTH_mm.low) -> float:
    """The largest length [mm] that is a step below another."""
    return level - step + 5e-10  # as in `step_up`


def span(low: float, high: float, digits: int = DIGITS) -> str | None:
    """``from LOW to HIGH``, no wider than the ends; None where nothing lies between.

    >>> span(0, 4.504113), span(0.6009999, 29.4), span(2, 1)
    ('from 0 to 4.50411', 'from 0.601 to 29.4', None)
    """
    for precision in range(digits, MOST_DIGITS + 1):
        first, last = _rounded(low, precision, up=True), _rounded(high, precision, up=False)
        if low <= float(first) <= float(last) <= high:
            return f"from {first} to {last}"
    return None


def lengths(low: float, high: float, digits: int = DIGITS) -> str | None:
    """`span` of what a length of the design file may be [mm]."""
    return span(max(low, LENGTH_mm.low), min(high, LENGTH_mm.high), digits)


def from_zero(high: float) -> str:
    """As `lengths`, for one that may be 0: ``from 0 to HIGH``, or ``0`` where nothing larger fits."""
    return span(0.0, min(high, LENGTH_mm.high)) or "0" if high >= LENGTH_mm.low else "0"


def beside(
    level: float, name: str, step: float, low: float, high: float, zero: bool = False
) -> str:
    """What makes no step, or a visible one, beside another length: ``0.4 (name) or from … to …``.

    A level of more digits is called by its name. `step` is the smallest that counts, `low` and `high` the
    ends of all; with `zero`, 0 is below `low`.
    """
    ranges = []
    if low <= level <= high or (zero and level == 0):
        few = f"{level:.{DIGITS}g}"
        ranges.append(f"{few} ({name})" if float(few) == level else f"exactly {name}")
    under = min(step_down(level, step), high)
    if zero and level >= step and under < LENGTH_mm.low:
        ranges.append("0")
    elif zero and level >= step:
        ranges.append(from_zero(under))
    elif (part := lengths(low, under)) is not None:
        ranges.append(part)
    if (part := lengths(max(step_up(level, step), low), high)) is not None:
        ranges.append(part)
    return joined(ranges, "or")


def outside(holes: Sequence[Interval], low: float, high: float) -> list[Interval]:
    """What is left of [low, high] without some open intervals."""
    left, start = [], low
    for a, b in sorted(holes):
        if a >= start:
            left.append((start, min(a, high)))
        start = max(start, b)
    left.append((start, high))
    return [(a, b) for a, b in left if a <= b]


def _rounded(value: float, digits: int, up: bool) -> str:
    plain = f"{value:.{digits}g}"
    if float(plain) == value:
        return plain
    exact = Decimal(value)
    last = Decimal(1).scaleb(exact.adjusted() - digits + 1)
    cut = exact.quantize(last, ROUND_CEILING if up else ROUND_FLOOR)
    return f"{float(cut):.{digits}g}"


def last_that(holds: Callable[[float], bool], inside: float, outside: float, width: float) -> float:
    """The value farthest from `inside` towards `outside` for which a condition holds, to within `width`.

    It holds at `inside`, not at `outside`, and changes once between them.
    """
    while abs(outside - inside) > width:
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if holds(middle) else (inside, middle)
    return inside
