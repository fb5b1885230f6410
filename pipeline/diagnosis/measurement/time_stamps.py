"""Dates and times of day as seconds from the first row."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

LAST_HOUR = 23
"""Last hour of a day. A clock with larger hours counts from the start."""
_PART = r"(?:(?:[.,]|:(?=\d{3}(?!\d)))(?P<part>\d{1,9}))?"
"""Of a second; after a colon they are milliseconds."""
_CLOCK = rf"(?P<hour>\d{{1,4}}):(?P<minute>\d{{2}})(?::(?P<second>\d{{2}}){_PART})?"
_ZONE = r"(?:\s?(?P<zone>Z|[+-]\d{2}:?\d{2}))?"
_DAY_ISO, _DAY_DOTS = r"\d{4}-\d{2}-\d{2}", r"\d{1,2}\.\d{1,2}\.\d{4}"
DAY = re.compile(f"{_DAY_ISO}|{_DAY_DOTS}", re.ASCII)
DATED = re.compile(
    rf"(?:(?P<iso>{_DAY_ISO})|(?P<dots>{_DAY_DOTS}))(?:[T ,]+{_CLOCK}{_ZONE})?", re.ASCII
)
TIME = re.compile(_CLOCK + _ZONE, re.ASCII)
SHORT = re.compile(rf"(?P<minute>\d{{1,4}}):(?P<second>[0-5]\d){_PART}", re.ASCII)
"""Two numbers: hours and minutes, or minutes and seconds."""
PART = re.compile(rf":\d{{2}}(?:[.,]|:(?=\d{{3}}))(\d{{1,9}}){_ZONE}$", re.ASCII)
"""The parts of a second, in a text of any kind."""
SLASHES = re.compile(r"\d{1,4}/\d{1,2}/\d{1,4}\b.*", re.ASCII)
"""Day first in Europe, month first in America: two readings."""


def is_stamp(text: str) -> bool:
    """Whether a text is a date, a time of day, or both; plain numbers are none."""
    return is_dated(text) or is_clock(text) or is_short(text) or is_slashed(text)


def is_slashed(text: str) -> bool:
    """Whether it is a date with slashes, which two readings fit."""
    return SLASHES.fullmatch(text) is not None


def is_day(text: str) -> bool:
    """Whether it is a date without a time of day."""
    return DAY.fullmatch(text) is not None


def is_dated(text: str) -> bool:
    """Whether it is a date, with a time of day or without."""
    return DATED.fullmatch(text) is not None


def is_clock(text: str) -> bool:
    """Whether it is a time of day without a date."""
    return TIME.fullmatch(text) is not None


def is_short(text: str) -> bool:
    """Whether it is two numbers with a colon between."""
    return SHORT.fullmatch(text) is not None


def short_are_minutes(texts: Sequence[str]) -> bool:
    """Whether only minutes and seconds explain some of the texts of two numbers."""
    short = [match for t in texts if (match := SHORT.fullmatch(t))]
    return any(match["part"] or int(match["minute"]) > LAST_HOUR for match in short)


def seconds_of(texts: Sequence[str], in_minutes: bool) -> tuple[list[float], int | None]:
    """Seconds from the first text, and the first text that is no stamp of its kind (None: all are).

    ISO 8601, `dd.mm.yyyy`, times of day, hours that go on beyond 23; a time zone counts where all have one.
    `in_minutes`: they are minutes and seconds.
    """
    read = _minutes if in_minutes else _dated if is_dated(texts[0]) else _time_of_day
    seconds: list[float] = []
    first: Moment | None = None
    for i, text in enumerate(texts):
        moment = read(text)
        if moment is None or (first is not None and moment.kind != first.kind):
            return seconds, i
        first = first or moment
        seconds.append((moment.since - first.since) / timedelta(seconds=1))
    return seconds, None


@dataclass(frozen=True)
class Moment:
    """A text as a time since a beginning that all texts of its kind share."""

    since: timedelta
    kind: str


def _dated(text: str) -> Moment | None:
    try:
        return _since_year_1(datetime.fromisoformat(text))  # fast, and most stamps are so
    except ValueError:
        pass
    match = DATED.fullmatch(text)
    if match is None:
        return None
    day, month, year = (match["dots"] or ".".join(reversed(match["iso"].split("-")))).split(".")
    zone = (match["zone"] or "").strip()
    try:
        midnight = datetime.fromisoformat(f"{year}-{month:0>2}-{day:0>2}T00:00{zone}")
    except ValueError:
        return None
    after = _clock(match)
    if after is None or after >= timedelta(days=1):
        return None
    return _since_year_1(midnight + after)


def _since_year_1(moment: datetime) -> Moment:
    year_1 = datetime.min.replace(tzinfo=moment.tzinfo and UTC)
    return Moment(moment - year_1, "date" if moment.tzinfo is None else "date with a zone")


def _time_of_day(text: str) -> Moment | None:
    match = TIME.fullmatch(text)
    after = match and _clock(match)
    if match is None or after is None:
        return None
    numbers = "hours and minutes" if match["second"] is None else "hours, minutes and seconds"
    return Moment(after, f"{numbers} {match['zone'] or ''}")


def _minutes(text: str) -> Moment | None:
    match = SHORT.fullmatch(text)
    return match and Moment(_after(int(match["minute"]), match), "minutes and seconds")


def _clock(match: re.Match[str]) -> timedelta | None:
    """None where minutes or seconds are beyond 59."""
    minutes, seconds = int(match["minute"] or 0), int(match["second"] or 0)
    if max(minutes, seconds) >= 60:
        return None
    return _after(60 * int(match["hour"] or 0) + minutes, match)


def _after(minutes: int, match: re.Match[str]) -> timedelta:
    part = float(f"0.{match['part'] or 0}")
    return timedelta(minutes=minutes, seconds=int(match["second"] or 0) + part)
