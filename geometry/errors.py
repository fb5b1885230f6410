"""Errors of the geometry room: each carries the numbers that explain it."""

from __future__ import annotations


class DesignError(ValueError):
    """A design that cannot be accepted: which key, its value, and what would work.

    Attributes
    ----------
    key : dotted key of the design file, e.g. ``flexspline.wall_thickness_mm``.
    value : what was found there.
    reason : one clause that names the workable range, with its numbers.
    """

    def __init__(self, key: str, value: object, reason: str) -> None:
        self.key, self.value, self.reason = key, value, reason
        super().__init__(f"{key} = {_short(value)}: {reason}")


class GeometryError(RuntimeError):
    """The CAD kernel did not produce the solid that the design describes."""


def _short(value: object, limit: int = 60) -> str:
    text = ascii(value) if isinstance(value, str) else str(value)
    text = " ".join(text.split())
    return text if len(text) <= limit else text[: limit - 1] + "…"
