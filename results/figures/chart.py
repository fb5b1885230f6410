"""Declaration of a run's chart: its inputs, its caption, and its width in the report."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from flexspline.pipeline.analysis import RunResult
    from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash
    from flexspline.results.report.content import ReportContent
    from flexspline.results.report.spans import Text


@dataclass(frozen=True)
class Chart:
    """A chart of a run: `CHART` of the file in this folder that has its name.

    Attributes
    ----------
    write : `write(path, *arguments)` draws it, in a process of its own.
    arguments : of a run, and of the sum with an extended model; None where there is nothing to show. The
        picture is kept by them.
    caption : below it in the report, and where it could not be drawn.
    width_pct : of the page's text, in print.
    """

    write: Callable[..., None]
    arguments: Callable[[RunResult, ExtendedBacklash | None], tuple[Any, ...] | None]
    caption: Callable[[ReportContent], Text]
    width_pct: float


def chart(name: str) -> Chart:
    """The chart of that name; its file is loaded when it is first asked for."""
    declared: Chart = import_module(f"flexspline.results.figures.{name}").CHART
    return declared
