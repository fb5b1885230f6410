"""Figures computed independently: a failed figure is reported, and the others are kept."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from flexspline.fea.shortfall import missing_because
from flexspline.fea.types import Shortfall
from flexspline.geometry.errors import ComputationError

T = TypeVar("T")


class Attempts:
    """Keeps in `missing` why a figure is not there, by its name ("K_b_lobes")."""

    def __init__(self) -> None:
        self.missing: dict[str, Shortfall] = {}

    def get(self, name: str, make: Callable[[], T]) -> T | None:
        """Return the figure, or None where its computation failed; bugs and wrong designs pass through.

        So does a NestingError (`pipeline.errors`): no figure is to be trusted then.
        """
        try:
            return make()
        except (ComputationError, MemoryError) as fault:
            self.missing[name] = missing_because(fault)
        return None
