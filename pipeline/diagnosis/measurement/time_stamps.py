"""Dates and times of day as seconds from the first row."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import datetime, timedelta

CLOCK = r"\d{1,2}:\d{2}(?::\d{2}(?:[.,]\d{1,9})?)?(?:\s?(?:Z|[+-]\d{2}:?\d{2}))?"
DAY_ISO, DAY_DOTS = r"\d{4}-\d{2}-\d{2}", r"\d{1,2}\.\d{1,2}\.\d{4}"
STAMP = re.compile(
    rf"(?:(?P<iso>{DAY_ISO})|(?P<dots>{DAY_DOTS}))?[T ,]*(?P<clock>{CLOCK})?", re.ASCII
)
SLASHES = re.compile(r"\d{1,4}/\d{1,2}/\d{1,4}\b.*", re.ASCII)
"""Day first in Europe, month first in America: two readings."""


def is_stamp(text: str) -> bool:
    """Whether a text is a date, a time of day, or both; plain numbers are none."""
    return bool(text) and (STAMP.fullmatch(text) is not None or is_slashed(text))


def is_slashed(text: str) -> bool:
    """Whether it is a date with slashes, which two readings fit."""
    return SLASHES.fullmatch(text) is not None


def is_day(text: str) -> bool:
    """Whether it is a date without a time of day."""
    return re.fullmatch(f"{DAY_ISO}|{DAY_DOTS}", text) is not None


def is_clock(text: str) -> bool:
    """Whether it is a time of day without a date."""
    return re.fullmatch(CLOCK, text) is not None


def seconds_of(texts: Sequence[str]) -> tuple[list[float], int | None]:
    """Seconds from the first text, and the first text that is no stamp of its kind (None: all are).

    ISO 8601, `dd.mm.yyyy` and times of day; a time zone counts where all have one.
    """
    found: list[float] = []
    first: datetime | None = None
    for i, text in enumerate(texts):
        moment = _moment(text)
        if moment is None or (
            first is not None and (moment.tzinfo is None) != (first.tzinfo is None)
        ):
            return found, i
        first = first or moment
        found.append((moment - first) / timedelta(seconds=1))
    return found, None


def _moment(text: str) -> datetime | None:
    try:
        return datetime.fromisoformat(text)  # fast, and most stamps are so
    except ValueError:
        pass
    match = STAMP.fullmatch(text)
    if match is None or not text:
        return None
    dots = (match["dots"] or "1.1.2000").split(".")  # any day serves for times of day
    day = match["iso"] or "-".join(_padded(p) for p in reversed(dots))
    clock = (match["clock"] or "00:00").replace(",", ".").replace(" ", "")
    hour, colon, rest = clock.partition(":")
    try:
        return datetime.fromisoformat(f"{day}T{_padded(hour)}{colon}{rest}")
    except ValueError:
        return None


def _padded(part: str) -> str:
    return part.rjust(2, "0")
