"""An assumed value: a key that the design file does not state, its value and the reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from flexspline.geometry.fields import DesignTable


@dataclass(frozen=True)
class Assumed:
    """A value [mm, N·m, or none] that the design file does not state, and where it comes from."""

    key: str
    value: float
    why: str


def taken_from(
    table: DesignTable, name: str, assumed: list[Assumed]
) -> Callable[[str, float, str], float]:
    """What a table states under a key, else a value, which `assumed` then gains with its reason."""

    def taken(key: str, value: float, why: str) -> float:
        stated = getattr(table, key)
        if stated is not None:
            return float(stated)
        assumed.append(Assumed(f"{name}.{key}", value, why))
        return value

    return taken
