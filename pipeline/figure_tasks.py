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
from flexspline.pipeline.ellipse_peak import ellipse_peak, full_seat_peak, half_seat_peak
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

    def add(self, other: Figures) -> None:
        """What another task found."""
        self.K |= other.K
        self.peaks |= other.peaks
        self.missing |= other.missing


@dataclass(frozen=True)
class _TaskResult:
    """Of one task; what a copy of this process remembers by then, and the seconds of its stages there."""

    figures: Figures
    passing: dict[str, Any]
    failed: dict[str, ComputationError]
    seconds: dict[str, float]


class FigureTasks:
    """What is asked for, long ones first, so that both processes or threads end together.

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
        """K of a part, by the name of the figure."""
        self._parts[len(self._tasks)] = part
        figures = partial(_stiffness, name, partial(part_stiffness, part))
        self._tasks.append(partial(self._found, figures))

    def add_rim(self, rim: PartModel) -> None:
        """What the lobes and the ellipse do to the rim."""
        for case in RIM_CASES:
            figures = partial(_stiffness, figure_of(case), partial(rim_stiffness, rim, case))
            self._tasks.append(partial(self._found, figures))
        for name, peak in (
            ("wave_generator_peak", ellipse_peak),
            ("half_seat_peak", half_seat_peak),
        ):
            self._tasks.append(partial(self._found, partial(_peak, name, partial(peak, rim))))
        if not rim.axisymmetric:
            whole = partial(_peak, "full_seat_peak", partial(full_seat_peak, rim))
            self._tasks.append(partial(self._found, whole))

    def figures(self, begun: Callable[[], None]) -> Figures:
        """All that was found; errors as of the tasks. `begun`: as of `results_of`."""
        figures = Figures()

        def told(number: int, found: _TaskResult) -> None:
            figures.add(found.figures)
            self._learn(found)
            if number in self._parts:
                self._solved(self._parts[number])

        if may_copy():
            results_of(self._tasks, begun, told)
            return figures
        begun()
        tasks = [partial(_then, task, partial(told, n)) for n, task in enumerate(self._tasks)]
        with beside(self._context.progress, tasks) as rest:
            rest()
        return figures

    def _learn(self, found: _TaskResult) -> None:
        """What a copy of this process remembers of its task."""
        cache = self._context.cache
        for known, there in ((cache.passing, found.passing), (cache.failed, found.failed)):
            known.update({key: value for key, value in there.items() if key not in known})
        for stage, seconds in found.seconds.items():
            self._context.progress.add(stage, seconds)

    def _found(self, make: Callable[[], Figures]) -> _TaskResult:
        if os.getpid() == self._process:
            return _TaskResult(make(), {}, {}, {})
        cache, seconds = self._context.cache, dict(self._context.progress.seconds)
        figures = make()
        return _TaskResult(
            figures,
            dict(cache.passing),
            dict(cache.failed),
            {k: s - seconds.get(k, 0.0) for k, s in self._context.progress.seconds.items()},
        )


def _then(task: Callable[[], _TaskResult], told: Callable[[_TaskResult], None]) -> None:
    told(task())


def _stiffness(name: str, solve: Callable[[], Stiffness]) -> Figures:
    tried = Attempts()
    K = tried.get(name, solve)
    return Figures({} if K is None else {name: K}, {}, tried.missing)


def _peak(name: str, find: Callable[[], StressPeak]) -> Figures:
    tried = Attempts()
    peak = tried.get(name, find)
    return Figures({}, {} if peak is None else {name: peak}, tried.missing)
