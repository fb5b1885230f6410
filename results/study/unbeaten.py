"""Where a study found nothing better than the design that it began with."""

from __future__ import annotations

from flexspline.pipeline.study.result import StudyResult
from flexspline.results.study.labels import entry, valued


def unbeaten_start(result: StudyResult) -> list[str]:
    """A sentence where the design that a study began with keeps to the constraints and beats every other."""
    file, start = result.study.file, result.start
    if start is None or len(file.objective) != 1 or not result.pareto:
        return []
    (key, goal), figures = next(iter(file.objective.items())), start.figures
    if any(k not in figures or c.excess(figures[k]) > 0 for k, c in file.constraint.items()):
        return []
    best = result.pareto[0].outcome.figures[key]
    if key not in figures or figures[key] == best or (figures[key] > best) != (goal == "maximize"):
        return []
    return [
        f"No design is better than the start: {entry(key).name} {valued(key, figures)}, of design "
        f"{result.pareto[0].slot} {valued(key, result.pareto[0].outcome.figures)}."
    ]
