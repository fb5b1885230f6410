"""A diagnosis as text for a terminal."""

from __future__ import annotations

from pathlib import Path

from flexspline.geometry.listed import listed
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome, NamedCause
from flexspline.results.diagnosis.advice import why
from flexspline.results.diagnosis.channels import channel_words, left_out_words
from flexspline.results.diagnosis.data_used import calibrated_sentences, own_slope
from flexspline.results.diagnosis.notes import notes
from flexspline.results.diagnosis.structure_words import structure_words
from flexspline.results.diagnosis.summary import summary, verdict_heading
from flexspline.results.diagnosis.words import (
    calibrated_words,
    cause_title,
    free_words,
    magnitude_words,
    noise_words,
    sure_words,
    title_of,
)
from flexspline.results.numbers import figures_text
from flexspline.results.sentences import capital
from flexspline.results.streams import files_in
from flexspline.results.terminal import prose, row

BETWEEN = 2
"""Letters between two columns, beside the one that parts all cells."""


def diagnosis_table(diagnosis: Diagnosis, folder: Path) -> str:
    """Verdict, causes, gain and what to measure next."""
    outcome = diagnosis.outcome
    lines = [f"{diagnosis.design.name} against {diagnosis.measurement.path.name}"]
    lines += prose(f"{verdict_heading(diagnosis)} ({outcome.verdict}). {summary(diagnosis)}")
    cells = [(_titled(c), magnitude_words(c), sure_words(c)) for c in outcome.causes]
    widths = [
        max(len(cell) for cell in column) + BETWEEN for column in list(zip(*cells, strict=True))[:2]
    ]
    for cause, texts in zip(outcome.causes, cells, strict=True):
        lines += row(texts, widths)
        if cause.alternatives:
            lines += prose(f"or: {', '.join(map(title_of, cause.alternatives))}", "      ")
    for u in outcome.unexplained:
        rms = f"{figures_text(u.rms)} {u.unit} rms"
        left = f"unexplained in {channel_words(u.channel)}: {rms}, {structure_words(u)}"
        lines += prose(left, "  ", "    ")
    if diagnosis.calibration is not None:
        lines += prose(
            calibrated_sentences(
                diagnosis.calibration, diagnosis.prediction, outcome, own_slope(diagnosis)
            )
        )
    lines += _errors(outcome)
    if outcome.next_measurement is not None:
        after = outcome.next_measurement
        lines += prose(
            f"Measure next ({channel_words(after.vary)}): {why(after, diagnosis.kind, diagnosis.causes)}"
        )
    for note in notes(diagnosis):
        lines += prose(f"note: {note}", "  ", "    ")
    lines += row((f"SHA-256 of the measurement: {diagnosis.measurement.read_as.sha256}",))
    lines.append(files_in(folder))
    return "\n".join(lines)


def _titled(cause: NamedCause) -> str:
    """With the units that alone have it, or have it in this size."""
    own = f", unit {listed(cause.own_units, 'units')}" if cause.own_units else ""
    return f"{capital(cause_title(cause))}{own}"


def _errors(outcome: DiagnosisOutcome) -> list[str]:
    """Errors on what was held out: between other cycles, then on whole amplitudes, rates and temperatures."""
    lines, gain = [], outcome.gain
    if gain is not None:
        held_out = left_out_words(gain.held_out)
        lines += row((f"Error on {held_out}, not used for fitting, in {gain.unit} rms:",))
        errors = {
            "simulation as designed": gain.rmse_before,
            calibrated_words(gain): gain.rmse_calibrated,
        }
        if outcome.causes:
            errors["with the identified causes"] = gain.rmse_after
        if free := free_words(outcome):
            errors[free] = gain.rmse_after
        errors[noise_words(gain)] = gain.noise_floor
        for words, value in errors.items():
            lines += row((words, figures_text(value)), (60,), "    ")
    if outcome.gains_at_levels:
        head = "Error on a level that was left out of the fit, in arcsec rms, without and with the causes:"
        lines += row((head,))
    for level in outcome.gains_at_levels:
        before, after = figures_text(level.rmse_before), figures_text(level.rmse_after)
        lines += row((left_out_words(level.held_out), before, after), (60, 7), "    ")
    return lines
