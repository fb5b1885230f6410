"""Time limit of a refinement: a mesh is not started if its solve would end too late."""

from __future__ import annotations

import time
from collections.abc import Callable
from math import inf

from flexspline.geometry.errors import ComputationError

STAGE_SECONDS = 60.0
"""Of a stage on the command line that solves on the meridian: 15 times what the slowest stage of 150 random
designs took on one core (3.2 s), so that a slow or busy machine meets it too."""
TIME_EXPONENT = 1.5
"""A mesh of twice the elements takes 2^1.5 times as long: factorising a plane mesh of n nodes takes n^1.5
operations at best (George, SINUM 10 (1973) 345-363), and all else takes less."""


class OutOfTimeError(ComputationError):
    """The next step would end after the time limit of `limit_s` seconds."""

    def __init__(self, limit_s: float) -> None:
        self.limit_s = limit_s
        super().__init__(f"it would take longer than the limit of {limit_s:g} s")


class Deadline:
    """A time limit of so many seconds from now on.

    `clock` [s] tells the time, `working` [s] how long this thread has been computing; tests give their own.
    """

    def __init__(
        self,
        limit_s: float,
        clock: Callable[[], float] = time.monotonic,
        working: Callable[[], float] = time.thread_time,
    ) -> None:
        self.limit_s, self._clock, self._began = limit_s, clock, clock()
        self.working = working

    def elapsed(self) -> float:
        """Return the seconds since the deadline was made."""
        return self._clock() - self._began


NO_DEADLINE = Deadline(inf)


class Pace:
    """Measures the time of steps towards a deadline, each on a mesh of its own size.

    A step is measured by the processor time of this thread: what other programs take on a busy machine is
    lost time, and no reason to expect the next step to take longer.
    """

    def __init__(self, deadline: Deadline) -> None:
        self._deadline = deadline
        self._began, self._elements = 0.0, 0

    def begin(self, elements: int) -> None:
        """A step on so many elements begins, and the one before has ended.

        Raises
        ------
        OutOfTimeError : it would not end in time if it took as long as the one before, and more by its size.
        """
        worked = self._deadline.working()
        needed = 0.0
        if self._elements:
            needed = (worked - self._began) * (elements / self._elements) ** TIME_EXPONENT
        if self._deadline.elapsed() + needed >= self._deadline.limit_s:
            raise OutOfTimeError(self._deadline.limit_s)
        self._began, self._elements = worked, elements
