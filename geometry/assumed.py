"""What a design file does not state, and where its value comes from."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Assumed:
    """A value [mm, N·m, or none] that the design file does not state, and where it comes from."""

    key: str
    value: float
    why: str
