"""Dates and times of day as seconds from the first row."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import datetime, timedelta

CLOCK = r"\d{1,2}:\d{2}(?::\d{2}(?:[.,]\d{1,9}|:\d{3})?)?(?:\s?(?:Z|[+-]\d{2}:?\d{2}))?"
DAY_ISO, DAY_DOTS = r"\d{4}-\d{2}-\d{2}", r"\d{1,2}\.\d{1,2}\.\d{4}"
LAST_HOUR = 23
STAMP = re.compile(
    rf"(?:(?P<iso>{DAY_ISO})|(?P<dots>{DAY_DOTS}))?[T ,]*(?P<clock>{CLOCK})?", re.ASCII
)
MILLISECONDS = re.compile(r":(?=\d{3}(?!\d))", re.ASCII)
"""The colon before them, in "hh:mm:ss:ms"."""
SHORT = re.compile(r"(\d{1,4}):([0-5]\d(?:[.,]\d{1,9})?)", re.ASCII)
"""Two numbers: hours and minutes, or minutes and seconds."""
_SECONDS = r"(?:ss?|se[ck])(?:[.,:](?:ms(?:ec)?|f+|s+|z+|0+))?"
"""Of a form, with what programs write for the parts of a second."""
FORMS = {
    "mm:ss": re.compile(rf"(?<!:)\b(?:mm?|min):{_SECONDS}\b", re.IGNORECASE),
    "hh:mm": re.compile(rf"\b(?:hh?|std):(?:mm?|min)(?::{_SECONDS})?\b", re.IGNORECASE),
}
"""How a head or a unit says which."""
SLASHES = re.compile(r"\d{1,4}/\d{1,2}/\d{1,4}\b.*", re.ASCII)
"""Day first in Europe, month first in America: two readings."""


def is_stamp(text: str) -> bool:
    """Whether a text is a date, a time of day, or both; plain numbers are none."""
    return bool(text) and (
        STAMP.fullmatch(text) is not None or SHORT.fullmatch(text) is not None or is_slashed(text)
    )


def is_slashed(text: str) -> bool:
    """Whether it is a date with slashes, which two readings fit."""
    return SLASHES.fullmatch(text) is not None


def is_day(text: str) -> bool:
    """Whether it is a date without a time of day."""
    return re.fullmatch(f"{DAY_ISO}|{DAY_DOTS}", text) is not None


def is_clock(text: str) -> bool:
    """Whether it is a time of day without a date."""
    return re.fullmatch(CLOCK, text) is not None


def form_said(head: str) -> str | None:
    """ "mm:ss" or "hh:mm" (also of "hh:mm:ss", "hh:mm:ss,ms") where the head of a column says so."""
    return next((form for form, said in FORMS.items() if said.search(head)), None)


def without_form(head: str) -> str:
    """The head without what `form_said` reads."""
    for said in FORMS.values():
        head = said.sub("", head)
    return head


def form_shown(texts: Sequence[str]) -> str | None:
    """ "mm:ss" where only that explains some of the texts; None where none does."""
    short = [found for t in texts if (found := SHORT.fullmatch(t))]
    seconds = any(not found[2].isdigit() or int(found[1]) > LAST_HOUR for found in short)
    return "mm:ss" if seconds else None


def is_short(text: str) -> bool:
    """Whether it is two numbers with a colon between."""
    return SHORT.fullmatch(text) is not None


def counted_seconds(texts: Sequence[str]) -> tuple[list[float], int | None]:
    """As `seconds_of`, for minutes and seconds."""
    found: list[float] = []
    for i, text in enumerate(texts):
        match = SHORT.fullmatch(text)
        if match is None:
            return found, i
        found.append(60 * int(match[1]) + float(match[2].replace(",", ".")))
    return [value - found[0] for value in found], None


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
    clock = MILLISECONDS.sub(".", clock)
    hour, colon, rest = clock.partition(":")
    try:
        return datetime.fromisoformat(f"{day}T{_padded(hour)}{colon}{rest}")
    except ValueError:
        return None


def _padded(part: str) -> str:
    return part.rjust(2, "0")
