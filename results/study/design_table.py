"""The report's table of designs: the best side by side, or some designs if there is no objective."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.result import StudyResult
from flexspline.results.peaks import BORDER, MEANING, at_border
from flexspline.results.report.document import Block, Column, Heading, Paragraph, Table
from flexspline.results.study.labels import LISTED_DESIGNS, entry
from flexspline.results.study.unbeaten import start_breaks

MARK = "†"
"""Beside a peak that hangs on the stress rule."""


def design_table(result: StudyResult) -> Iterable[Block]:
    """A line per varied key and figure: name, then each design's values."""
    chosen = _chosen(result)
    if not chosen:
        return
    begun = () if result.start is None else (result.start.figures,)
    lines: list[tuple[str, ...]] = []
    for key in result.study.file.vary:
        q = entry(key)
        values = (*(result.study.start_values for _ in begun), *(r.values for r in chosen))
        lines.append((q.axis, *(q.text(v[key]) if key in v else "" for v in values)))
    for key in _figures(result, chosen):
        cells = (_text(key, f) for f in (*begun, *(r.outcome.figures for r in chosen)))
        lines.append((entry(key).axis, *cells))
    breaks = start_breaks(result)
    first = "start (not allowed)" if breaks else "start"
    heads = (*(first for _ in begun), *(_head(result, r) for r in chosen))
    yield Heading("The best designs" if result.study.file.objective else "The built designs")
    yield Table((Column("", grow=1), *(Column(head, "right") for head in heads)), tuple(lines))
    if marked_figures(result):
        yield Paragraph(f"{MARK} {BORDER}: {MEANING}.")
    if begun:
        remark = "start: the design of the study file before any change, solved in the same way"
        yield Paragraph(f"{remark}; it {breaks}." if breaks else f"{remark}.")


def marked_figures(result: StudyResult) -> set[str]:
    """Figures that have a MARK in the table."""
    chosen = _chosen(result)
    begun = () if result.start is None or not chosen else (result.start.figures,)
    listed = (*begun, *(r.outcome.figures for r in chosen))
    return {k for k in _figures(result, chosen) if any(k in f and at_border(k, f) for f in listed)}


def _chosen(result: StudyResult) -> tuple[Row, ...]:
    """Without an objective none is best: all that were built, unless they are many and a chart shows them."""
    if result.about_scatter:
        return ()
    if result.study.file.objective:
        return result.best(LISTED_DESIGNS)
    return result.built if len(result.built) <= LISTED_DESIGNS else ()


def _figures(result: StudyResult, chosen: tuple[Row, ...]) -> list[str]:
    """Those looked at, constrained and the mass, as far as every design has them."""
    keys = dict.fromkeys([*result.shown, *result.study.file.constraint, "flexspline_mass_g"])
    return [k for k in keys if all(k in r.outcome.figures for r in chosen)]


def _head(result: StudyResult, row: Row) -> str:
    return f"design {row.slot}" if row in result.feasible else f"design {row.slot} (not allowed)"


def _text(key: str, figures: Mapping[str, float]) -> str:
    if key not in figures:  # the start may lack what each row has
        return ""
    return entry(key).text(figures[key]) + (f" {MARK}" if at_border(key, figures) else "")
