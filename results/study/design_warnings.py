"""Warnings of `flexspline run` for a study's designs: the first, the best, and their number."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import chain

from flexspline.geometry.design import Design
from flexspline.geometry.sanity import warnings
from flexspline.pipeline.first_face import held_beyond_flange, is_too_large, too_large_line
from flexspline.pipeline.stress_limits import PART_OF, Peak, limits_passed
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.result import StudyResult
from flexspline.results.limit_words import passed_line
from flexspline.results.peaks import tabled_peak
from flexspline.results.study.failures import without_numbers
from flexspline.results.study.labels import LISTED_DESIGNS

COUNTED_DESIGNS = 10_000
"""Of which it is counted who has a warning: a design is read again in 0.12 ms, so 1.2 s; of more, none."""
WHOLE_FACE = "K_e, the shaft's whole first face held"
"""The kind of that warning; its line takes two solves, so it is made for a design that is told of alone."""
FIRST = "start design"


@dataclass(frozen=True)
class _Warning:
    """A line ("" of WHOLE_FACE), and what it has in common with those of other designs."""

    line: str
    kind: str


def design_warnings(result: StudyResult) -> list[str]:
    """A line for each warning of the best design and of the first, and the numbers of other listed designs
    with lines of their own."""
    best, *others = _listed(result) or (None,)
    first = _of_design(result.study.design)
    of_best = [] if best is None else _of_row(result, best)
    kinds = {warning.kind for warning in of_best}
    begun = result.study.design
    numbered = [(f"design {best.slot}", result.design_of(best), w) for w in of_best] if best else []
    numbered += [(FIRST, begun, warning) for warning in first if warning.kind not in kinds]
    count = _counts(result) if numbered else None
    lines = [
        f"{name}{_in_how_many(count, w.kind, result)}: {w.line or too_large_line(design)}"
        for name, design, w in numbered
        if w.kind != WHOLE_FACE or is_too_large(design)
    ]
    known = {*first, *of_best}
    if more := [str(row.slot) for row in others if not known.issuperset(_of_row(result, row))]:
        lines.append(
            f"other listed designs with warnings: {', '.join(more)}; to read them, put a design's row of "
            "study.csv into a design file and run flexspline run on it"
        )
    return lines


def _listed(result: StudyResult) -> tuple[Row, ...]:
    return () if result.about_scatter else result.best(LISTED_DESIGNS)


def _of_design(design: Design) -> list[_Warning]:
    """Of its dimensions; the cure behind a warning, which not every design has, is no part of the kind."""
    of_dimensions = [
        _Warning(line, without_numbers(line.partition("; ")[0])) for line in warnings(design)
    ]
    return (
        [*of_dimensions, _Warning("", WHOLE_FACE)] if held_beyond_flange(design) else of_dimensions
    )


def _of_row(result: StudyResult, row: Row) -> list[_Warning]:
    """Of its dimensions, and the limits that its peaks pass."""
    design = result.design_of(row)
    passed = limits_passed(design, _peaks(row))
    return [*_of_design(design), *(_Warning(passed_line(p), f"{p.name} {p.key}") for p in passed)]


def _counts(result: StudyResult) -> Counter[str] | None:
    """In how many of the designs built each kind of warning stands; None of too many designs."""
    if not 1 < len(result.built) <= COUNTED_DESIGNS:
        return None
    kinds = ({warning.kind for warning in _of_row(result, row)} for row in result.built)
    return Counter(chain.from_iterable(kinds))


def _in_how_many(count: Counter[str] | None, kind: str, result: StudyResult) -> str:
    return "" if count is None else f" (in {count[kind]} of {len(result.built)} designs)"


def _peaks(row: Row) -> dict[str, Peak]:
    """Those that the row has, by their names in result.json."""
    figures = row.outcome.figures
    there = (name for name in PART_OF if f"{name}_mises_MPa" in figures)
    return {name: tabled_peak(name, figures) for name in there}
