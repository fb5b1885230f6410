"""The best design of a study: as a design file, and what `flexspline run` would warn of in it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from flexspline.geometry.sanity import warnings
from flexspline.geometry.template import design_text
from flexspline.pipeline.stress_limits import PART_OF, Peak, TabledPeak, limits_passed
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.result import StudyResult
from flexspline.results.atomic import write_bytes
from flexspline.results.file_names import BEST_DESIGN
from flexspline.results.limit_words import passed_line
from flexspline.results.study.labels import LISTED_DESIGNS, at_border


def write_best_design(folder: Path, result: StudyResult) -> Path | None:
    """Write the first of the best designs beside the table; None where no design is better than another."""
    if result.about_scatter or not result.pareto:
        return None
    row = result.pareto[0]
    name = f"{result.study.design.name}, design {row.slot} of {result.study.name}"
    design = result.design_of(row).model_copy(update={"name": name})
    path = folder / BEST_DESIGN
    write_bytes(path, design_text(design).encode())
    return path


def best_warnings(result: StudyResult) -> Iterable[str]:
    """Of the first of the best designs, a line each; the numbers of the others that have some."""
    if result.about_scatter:
        return
    said = [(row.slot, tuple(_warnings(result, row))) for row in result.best(LISTED_DESIGNS)]
    for slot, lines in said[:1]:
        yield from (f"design {slot}: {line}" for line in lines)
    if others := [str(slot) for slot, lines in said[1:] if lines]:
        yield (
            f"other listed designs with warnings: {', '.join(others)}; to read them, put a design's row of "
            "study.csv into a design file and run flexspline run on it"
        )


def _warnings(result: StudyResult, row: Row) -> Iterable[str]:
    """What the varied dimensions brought about: the first design's own warnings are not repeated."""
    design = result.design_of(row)
    known = set(warnings(result.study.design))
    yield from (line for line in warnings(design) if line not in known)
    yield from map(passed_line, limits_passed(design, _peaks(row)))


def _peaks(row: Row) -> dict[str, Peak]:
    """Those that the row has, by their names in result.json."""
    figures = row.outcome.figures
    keys = {name: f"{name}_mises_MPa" for name in PART_OF}
    return {
        name: TabledPeak(figures[key], at_border(key, figures))
        for name, key in keys.items()
        if key in figures
    }
