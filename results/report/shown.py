"""Which of a report's pictures there are."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from results.report.content import ReportContent
from results.report.document import Block, Picture, Pictures


def shown(content: ReportContent, roomy: bool, *wanted: Picture) -> Iterable[Block]:
    """Those of the pictures that there are, side by side; a little smaller where room is short."""
    there = [p for p in wanted if getattr(content.pictures, p.name) is not None]
    if there:
        share = 1.0 if roomy or len(wanted) > 1 else 0.85
        yield Pictures(tuple(replace(p, width_pct=share * p.width_pct) for p in there))
