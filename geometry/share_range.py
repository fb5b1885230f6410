"""The range of an optional length that is stated as a share of another one."""

from __future__ import annotations

from collections.abc import Iterator

from flexspline.geometry.bounds import Interval, lengths
from flexspline.geometry.errors import DesignError

DIGITS = 4
"""Of the range's ends in the message: enough to see a slipped decimal point."""


def share_faults(
    key: str, value: float | None, shares: Interval, whole: float, words: str, rounding: float = 0.0
) -> Iterator[DesignError]:
    """A value [mm] outside `shares` of a length `whole` [mm], which the message calls `words`.

    `rounding`: the share by which a value may exceed the upper end.
    """
    low, high = shares[0] * whole, shares[1] * whole * (1 + rounding)
    if value is not None and not low <= value <= high:
        yield DesignError(
            key,
            value,
            f"must be {lengths(low, high, DIGITS)} mm, {shares[0]:g} to {shares[1]:g} of {words}",
        )
