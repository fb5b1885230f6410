"""Computes a design's figures two at a time: in two processes if possible, otherwise in two threads.

Threads share Python's interpreter: on two cores two processes take three quarters of their time.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from flexspline.fea.types import Shortfall, Stiffness, StressPeak
from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.attempts import Attempts
from flexspline.pipeline.ellipse_peak import ellipse_peak, half_seat_peak
from flexspline.pipeline.load_cases import rim_stiffness
from flexspline.pipeline.part_stiffness import part_stiffness
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.rim_case import RIM_CASES, figure_of
from flexspline.pipeline.second_process import may_copy, results_of
from flexspline.pipeline.two_threads import beside


@dataclass
class Figures:
    """K and peak stresses by name, and why others are missing."""

    K: dict[str, Stiffness] = field(default_factory=dict)
    peaks: dict[str, StressPeak] = field(default_factory=dict)
    missing: dict[str, Shortfall] = field(default_factory=dict)


@dataclass(frozen=True)
class _TaskResult:
    """A figure, or why it is missing; what a copy of this process remembers by then, and its stages [s]."""

    name: str
    figure: Stiffness | StressPeak | None
    missing: dict[str, Shortfall]
    passing: dict[str, Any]
    failed: dict[str, ComputationError]
    seconds: dict[str, float]


class FigureTasks:
    """The tasks of a command, long ones first, so that both processes or threads end together.

    Lift-off has no solid model: it stands between two cases that may have large ones, of which one waits for
    the other (`fea.solid.alone`).
    """

    def __init__(self, context: AnalysisContext, solved: Callable[[PartModel], None]) -> None:
        """`solved` is told each part after its K, by one of two threads."""
        self._context, self._solved = context, solved
        self._tasks: list[Callable[[], _TaskResult]] = []
        self._parts: dict[int, PartModel] = {}
        self._process = os.getpid()

    def add_part(self, name: str, part: PartModel) -> None:
        """Add a task for K of a part, under the name of the figure."""
        self._parts[len(self._tasks)] = part
        self._add(name, partial(part_stiffness, part))

    def add_rim(self, rim: PartModel) -> None:
        """Add tasks for the lobe cases and the peaks on the wave generator."""
        for case in RIM_CASES:
            self._add(figure_of(case), partial(rim_stiffness, rim, case))
        self._add("wave_generator_peak", partial(ellipse_peak, rim))
        self._add("half_seat_peak", partial(half_seat_peak, rim))

    def _add(self, name: str, solve: Callable[[], Stiffness | StressPeak]) -> None:
        self._tasks.append(partial(self._result, name, solve))

    def figures(self, begun: Callable[[], None]) -> Figures:
        """Run all tasks and return their figures; errors as of the tasks. `begun`: as of `results_of`."""
        figures = Figures()

        def take_in(number: int, result: _TaskResult) -> None:
            figures.missing |= result.missing
            if isinstance(result.figure, StressPeak):
                figures.peaks[result.name] = result.figure
            elif result.figure is not None:
                figures.K[result.name] = result.figure
            self._learn(result)
            if number in self._parts:
                self._solved(self._parts[number])

        if may_copy():
            results_of(self._tasks, begun, take_in)
            return figures

        def solve(number: int) -> None:
            take_in(number, self._tasks[number]())

        begun()
        numbers = range(len(self._tasks))
        with beside(self._context.progress, [partial(solve, n) for n in numbers]) as rest:
            rest()
        return figures

    def _learn(self, result: _TaskResult) -> None:
        """What a copy of this process remembers of its task."""
        cache = self._context.cache
        for known, there in ((cache.passing, result.passing), (cache.failed, result.failed)):
            known.update({key: value for key, value in there.items() if key not in known})
        for stage, seconds in result.seconds.items():
            self._context.progress.add(stage, seconds)

    def _result(self, name: str, solve: Callable[[], Stiffness | StressPeak]) -> _TaskResult:
        cache, tried = self._context.cache, Attempts()
        before = dict(self._context.progress.seconds)
        figure = tried.get(name, solve)
        if os.getpid() == self._process:
            return _TaskResult(name, figure, tried.missing, {}, {}, {})
        seconds = {k: s - before.get(k, 0.0) for k, s in self._context.progress.seconds.items()}
        known = dict(cache.passing), dict(cache.failed)
        return _TaskResult(name, figure, tried.missing, *known, seconds)
