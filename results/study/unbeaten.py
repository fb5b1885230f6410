"""Remarks on the first design of a study: it breaks a constraint, or no design is better."""

from __future__ import annotations

from flexspline.pipeline.study.result import StudyResult
from flexspline.results.study.labels import beyond, entry, valued
from flexspline.results.study.why import allowed


def start_breaks(result: StudyResult) -> str:
    """Which constraints the design that a study began with breaks, with its figures; "" for none."""
    if result.start is None:
        return ""
    figures = result.start.figures
    broken = [
        f"{entry(key).name} {beyond(key, figures, (limit.min, limit.max))}, allowed: {allowed(key, limit)}"
        for key, limit in result.study.file.constraint.items()
        if key in figures and limit.excess(figures[key]) > 0
    ]
    return f"breaks a constraint ({'; '.join(broken)})" if broken else ""


def unbeaten_start(result: StudyResult) -> list[str]:
    """A sentence where the design that a study began with keeps to the constraints and beats every other."""
    file, start = result.study.file, result.start
    if start is None or len(file.objective) != 1 or not result.pareto:
        return []
    (key, goal), figures = next(iter(file.objective.items())), start.figures
    if start_breaks(result) or any(k not in figures for k in file.constraint):
        return []
    best = result.pareto[0].outcome.figures[key]
    if key not in figures or figures[key] == best or (figures[key] > best) != (goal == "maximize"):
        return []
    return [
        f"No design is better than the start design: {entry(key).name} {valued(key, figures)}; design "
        f"{result.pareto[0].slot}: {valued(key, result.pareto[0].outcome.figures)}."
    ]
