"""Program version and date of a report."""

from __future__ import annotations

import os
from datetime import UTC, datetime

from flexspline import __version__


def issued(version: str = "") -> str:
    """``flexspline 0.1.0 · 2026-11-22``: the program and today's date.

    The date is that of SOURCE_DATE_EPOCH (seconds, UTC) where the environment gives it: then the same
    content gives the same bytes on any day.
    """
    return f"flexspline {version or __version__} · {_day()}"


def _day() -> str:
    stated = os.environ.get("SOURCE_DATE_EPOCH", "")
    try:
        return datetime.fromtimestamp(int(stated), UTC).date().isoformat()
    except (ValueError, OverflowError, OSError):
        return datetime.now().astimezone().date().isoformat()
