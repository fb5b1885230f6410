"""Charts and pictures of a section, or the reason why one is missing."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from flexspline.results.figures.chart import chart
from flexspline.results.file_names import CHARTS_OF, ChartSection
from flexspline.results.report.content import ReportContent
from flexspline.results.report.document import Block, Callout, Picture, Pictures
from flexspline.results.report.spans import bold, plain


def shown_charts(content: ReportContent, roomy: bool, section: ChartSection) -> Iterable[Block]:
    """Those of `CHARTS_OF` a section, one below another."""
    for name in CHARTS_OF[section]:
        one = chart(name)
        yield from shown(content, roomy, Picture(name, one.caption(content), one.width_pct))


def shown(content: ReportContent, roomy: bool, *wanted: Picture) -> Iterable[Block]:
    """Those of the pictures that there are, side by side; a little smaller where room is short.

    In place of those that could not be drawn stands what they would show, and the reason.
    """
    there = [p for p in wanted if p.name in content.pictures]
    if there:
        share = 1.0 if roomy or len(wanted) > 1 else 0.85
        yield Pictures(tuple(replace(p, width_pct=share * p.width_pct) for p in there))
    missing = content.missing_pictures
    for reason in dict.fromkeys(missing[p.name] for p in wanted if p.name in missing):
        these = tuple(p.caption for p in wanted if missing.get(p.name) == reason)
        yield Callout("amber", text=bold("Not drawn: ") + plain(f"{reason}."), items=these)
