"""The time format that a column's heading states: "hh:mm:ss,ms", "mm:ss", "%H:%M:%S.%f"."""

from __future__ import annotations

import re
from dataclasses import dataclass

HOURS_MINUTES, MINUTES_SECONDS, ALL = "hh:mm", "mm:ss", "hh:mm:ss"
_HOUR, _MINUTE, _SECOND = r"(?:hh?|std|%H)", r"(?:mm?|min|%M)", r"(?:ss?|se[ck]|%S)"
_PART = r"(?:[.,:](?P<{}>ms(?:ec)?|[uµμ]s|%f|f+|s+|z+|m+|x+|0+))?"
"""What programs write for the parts of a second."""
_DAY = r"(?:(?:%?[ydmjt]{1,4}[-./]){2}%?[ydmjt]{1,4}[ T,]+)?"
_FORM = re.compile(
    rf"(?<![^\W_])(?<!:){_DAY}"
    rf"(?:(?P<hour>{_HOUR}):{_MINUTE}(?::(?P<second>{_SECOND}){_PART.format('after_hour')})?"
    rf"|{_MINUTE}:{_SECOND}{_PART.format('after_minute')})(?![^\W_]|:)",
    re.IGNORECASE,
)
_DIGITS = {"ms": 3, "msec": 3, "us": 6, "µs": 6, "μs": 6, "%f": 6}
"""Digits after the second: thousandths or millionths; %f is six by C and Python. Of letters, one each."""


@dataclass(frozen=True)
class TimeForm:
    """What a head says: which numbers a time has, and the digits that its parts of a second are written with.

    `parts_digits` is 0 where it says nothing of parts of a second.
    """

    numbers: str
    parts_digits: int = 0


def form_said(head: str) -> TimeForm | None:
    """The form, None where the head says none."""
    match = _FORM.search(head)
    if match is None:
        return None
    part = (match["after_hour"] or match["after_minute"] or "").lower()
    digits = _DIGITS.get(part, len(part))
    if match["hour"] is None:
        return TimeForm(MINUTES_SECONDS, digits)
    return TimeForm(HOURS_MINUTES if match["second"] is None else ALL, digits)


def without_form(head: str) -> str:
    """The head without what `form_said` reads."""
    return _FORM.sub("", head)


def is_parted(head: str, following: str) -> bool:
    """Whether two heads in a row hold one form: "[hh:mm:ss" and "ms]", cut at the comma, or two columns."""
    one, both = form_said(head), form_said(f"{head},{following}")
    return one is not None and both is not None and one != both
