"""Notes on a gap that is not one and the same in the whole record: which gap the calibrated one is."""

from __future__ import annotations

from collections.abc import Sequence

from flexspline.pipeline.diagnosis.causes.wear import WEAR
from flexspline.pipeline.diagnosis.outcome import Unexplained
from flexspline.pipeline.diagnosis.sweep.diagnose import SweepAnalysis
from flexspline.pipeline.diagnosis.sweep.magnitudes.own_gaps import own_gaps
from flexspline.results.diagnosis.structure_words import words_of
from flexspline.results.diagnosis.words import title_of


def gap_notes(analysis: SweepAnalysis, unexplained: Sequence[Unexplained]) -> list[str]:
    """One line for each channel whose levels have gaps of their own, and one for wear."""
    mean = analysis.calibration.gap_arcsec.value
    lines = []
    for own in own_gaps(analysis.explained, unexplained):
        least, greatest = mean + own.least_arcsec, mean + own.greatest_arcsec
        lines.append(
            f"{words_of((own.form,), own.channel)}: the calibrated gap is the mean, {mean:.1f} arcsec; they "
            f"lie between {least:.1f} and {greatest:.1f}, with a standard deviation of {own.std_arcsec:.1f}"
        )
    if any(c.id == WEAR for c in analysis.causes):
        lines.append(
            f"the calibrated gap is that at the start of the record; {title_of(WEAR)} adds to it"
        )
    return lines
