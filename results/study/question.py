"""The task of a study as its report repeats it: varied keys, objectives, constraints."""

from __future__ import annotations

from collections.abc import Iterable

from flexspline.geometry.listed import listed
from flexspline.pipeline.study.schema import Link, Spread, VariedSpan
from flexspline.pipeline.study.study import Study
from flexspline.results.report.document import Block, Column, Heading, Table
from flexspline.results.study.labels import entry
from flexspline.results.study.why import allowed

MOST_VALUES = 6
"""Of a list that are all written."""
SENSES = {"minimize": "as small as possible", "maximize": "as large as possible"}


def question(study: Study) -> Iterable[Block]:
    """A table of the study file's own words."""
    file = study.file
    lines = [("varied", entry(k).name, _span(k, span)) for k, span in file.vary.items()]
    lines += [("linked", entry(k).name, _link(k, link)) for k, link in file.link.items()]
    lines += [("tolerance", entry(k).name, _spread(k, s)) for k, s in file.tolerance.items()]
    lines += [("objective", entry(k).name, SENSES[sense]) for k, sense in file.objective.items()]
    lines += [
        ("constraint", entry(k).name, allowed(k, limit)) for k, limit in file.constraint.items()
    ]
    if lines:
        yield Heading("The task")
        yield Table((Column(""), Column("Quantity", grow=1), Column("Range", grow=1)), tuple(lines))


def _span(key: str, span: VariedSpan) -> str:
    q = entry(key)
    if span.values is not None and len(span.values) <= MOST_VALUES:
        return f"{listed([q.text(v) for v in span.values], 'values')} {q.unit}".rstrip()
    low, high = span.ends
    count = len(span.values) if span.values is not None else span.steps
    steps = f", {count} values" if count else ""
    return f"{q.text(low)} to {q.text(high)} {q.unit}".rstrip() + steps


def _link(key: str, link: Link) -> str:
    times = "" if link.times == 1 else f"{link.times:g} · "
    text = f"{times}{entry(link.of).name}"
    if link.plus:
        text += f" {'+' if link.plus > 0 else '−'} {abs(link.plus):g} {entry(key).unit}"
    return text.rstrip()


def _spread(key: str, spread: Spread) -> str:
    q = entry(key)
    if spread.plus_minus is not None:
        return f"± {spread.plus_minus:g} {q.unit}".rstrip() + ", uniform"
    return f"standard deviation {spread.std:g} {q.unit}".rstrip()
