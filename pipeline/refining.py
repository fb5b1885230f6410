"""A result that improves with each mesh, refined as far as requested."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from threading import Lock
from typing import Generic, TypeVar

from flexspline.geometry.errors import ComputationError

T = TypeVar("T")


class Refining(Generic[T]):
    """The answers of finer and finer meshes; a thread that asks while another refines waits for it.

    Attributes
    ----------
    newest : that of the finest mesh so far, of the first one at least.
    """

    def __init__(self, answers: Iterator[T]) -> None:
        self._answers = answers
        self._fault: ComputationError | None = None
        self._refines = Lock()
        self.newest = next(answers)

    def until(self, enough: Callable[[T], bool]) -> T:
        """Return the newest answer, refined until it is enough or the last; a fault as of `last`."""
        with self._refines:
            while not enough(self.newest) and self._next():
                pass
            return self.newest

    def last(self) -> T:
        """Return the answer within the tolerance; the fault that ended the refinement is raised each time."""
        return self.until(lambda answer: False)

    def _next(self) -> bool:
        """Whether there was one more."""
        if self._fault is not None:
            raise self._fault
        try:
            better = next(self._answers, None)
        except ComputationError as fault:
            self._fault = fault
            raise
        if better is None:
            return False
        self.newest = better
        return True
