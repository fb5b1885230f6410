"""Capital letters and full stops for sentences."""

from __future__ import annotations


def capital(text: str) -> str:
    """First letter large."""
    return text[:1].upper() + text[1:]


def sentence(clause: str) -> str:
    """A clause by itself: first letter large, a full stop."""
    return f"{capital(clause)}."
