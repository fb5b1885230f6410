"""An answer that each mesh makes better, solved as far as somebody asked."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Generic, TypeVar

from flexspline.geometry.errors import ComputationError

T = TypeVar("T")


class Refining(Generic[T]):
    """The answers of finer and finer meshes.

    Attributes
    ----------
    newest : that of the finest mesh so far, of the first one at least.
    """

    def __init__(self, answers: Iterator[T]) -> None:
        self._answers = answers
        self._fault: ComputationError | None = None
        self.newest = next(answers)

    def last(self) -> T:
        """The one within the tolerance; the fault that ended the refinement is raised each time."""
        if self._fault is not None:
            raise self._fault
        try:
            for better in self._answers:
                self.newest = better
        except ComputationError as fault:
            self._fault = fault
            raise
        return self.newest
