"""Gaps that differ from cycle to cycle, or from position to position, without a law: how far they scatter.

The calibrated gap is their mean (`../evidence/fit.py`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from flexspline.pipeline.diagnosis.outcome import Unexplained
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.evidence.fit import first_of_levels
from flexspline.pipeline.diagnosis.sweep.magnitudes.cancelling_terms import terms_cancel
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep


@dataclass(frozen=True)
class OwnGaps:
    """The gaps over a channel's levels, less their mean: the least, the greatest, and their deviation
    [arcsec]."""

    channel: str
    form: UnnamedForm
    least_arcsec: float
    greatest_arcsec: float
    std_arcsec: float


def own_gaps(explained: ExplainedSweep, unexplained: Sequence[Unexplained]) -> Iterator[OwnGaps]:
    """Of each channel with a gap of each level's own; none where the calibration is without such terms."""
    if terms_cancel(explained.identified):
        return
    fit = explained.identified.fit
    history = fit.rig.history
    for found in unexplained:
        forms = found.structure if isinstance(found.structure, tuple) else ()
        form = next((f for f in forms if f.kind == "own_gap"), None)
        rows = first_of_levels(history, found.channel)
        if form is None or rows is None:
            continue
        gap = 2 * history.sign * fit.added_by_form(f"?{found.channel}", form.kind)
        each = gap[rows] - gap[rows].mean()
        yield OwnGaps(
            found.channel, form, float(each.min()), float(each.max()), float(each.std(ddof=1))
        )
