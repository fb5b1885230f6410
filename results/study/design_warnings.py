"""What `flexspline run` would warn of in a study's designs: the first, the best, and how many."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from flexspline.geometry.design import Design
from flexspline.geometry.sanity import warnings
from flexspline.pipeline.stress_limits import PART_OF, Peak, TabledPeak, limits_passed
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.result import StudyResult
from flexspline.results.limit_words import passed_line
from flexspline.results.study.failures import without_numbers
from flexspline.results.study.labels import LISTED_DESIGNS, at_border

COUNTED_DESIGNS = 10_000
"""Of which it is counted who has a warning: a design is read again in 0.12 ms, so 1.2 s; of more, none."""
FIRST = "the design that the study begins with"


def design_warnings(result: StudyResult) -> list[str]:
    """A line for each warning of the best design and of the first, and the numbers of other listed designs
    with lines of their own."""
    best, *others = _listed(result) or (None,)
    first = warnings(result.study.design)
    of_best = [] if best is None else warnings(result.design_of(best))
    kinds = {_kind(line) for line in of_best}
    told = [(f"design {best.slot}", line) for line in of_best] if best else []
    told += [(FIRST, line) for line in first if _kind(line) not in kinds]
    count = _counts(result) if told else None
    said = [f"{name}{_in_how_many(count, line, result)}: {line}" for name, line in told]
    if best:
        said += [f"design {best.slot}: {line}" for line in _passed(result.design_of(best), best)]
    known = {*first, *of_best}
    if more := [str(row.slot) for row in others if _has_more(result.design_of(row), row, known)]:
        said.append(
            f"other listed designs with warnings: {', '.join(more)}; to read them, put a design's row of "
            "study.csv into a design file and run flexspline run on it"
        )
    return said


def _listed(result: StudyResult) -> tuple[Row, ...]:
    return () if result.about_scatter else result.best(LISTED_DESIGNS)


def _kind(line: str) -> str:
    """A warning without its numbers and without the cure behind it, which not every design has."""
    return without_numbers(line.partition("; ")[0])


def _counts(result: StudyResult) -> Counter[str] | None:
    """In how many of the designs built each kind of warning stands; None of too many designs."""
    if not 1 < len(result.built) <= COUNTED_DESIGNS:
        return None
    each = (warnings(result.design_of(row)) for row in result.built)
    return Counter(kind for lines in each for kind in {_kind(line) for line in lines})


def _in_how_many(count: Counter[str] | None, line: str, result: StudyResult) -> str:
    if count is None:
        return ""
    return f" (in {count[_kind(line)]} of {len(result.built)} designs)"


def _has_more(design: Design, row: Row, known: set[str]) -> bool:
    """Whether a design has a warning beyond those known."""
    return not known.issuperset(warnings(design)) or any(_passed(design, row))


def _passed(design: Design, row: Row) -> Iterable[str]:
    """The limits that a row's peaks pass."""
    return map(passed_line, limits_passed(design, _peaks(row)))


def _peaks(row: Row) -> dict[str, Peak]:
    """Those that the row has, by their names in result.json."""
    figures = row.outcome.figures
    keys = {name: f"{name}_mises_MPa" for name in PART_OF}
    return {
        name: TabledPeak(figures[key], at_border(key, figures))
        for name, key in keys.items()
        if key in figures
    }
