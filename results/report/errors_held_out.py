"""The errors on data that were not used for fitting, in the report of a diagnosis."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from flexspline.geometry.percent import percent_of_all
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome, Gain
from flexspline.results.diagnosis.channels import left_out_words
from flexspline.results.diagnosis.words import calibrated_words, free_words, noise_words
from flexspline.results.numbers import figures_text
from flexspline.results.report.document import Block, Column, Heading, Paragraph, Table
from flexspline.results.sentences import capital


def errors_held_out(outcome: DiagnosisOutcome) -> Iterable[Block]:
    """On cycles, positions or units between others."""
    gain = outcome.gain
    if gain is None:
        return
    yield Heading("Prediction error on data not used in the fit")
    yield Paragraph(f"Held out: {left_out_words(gain.held_out)}.")
    yield Table(
        columns=(Column("Prediction by", grow=1), Column(f"{gain.unit} rms", "right")),
        rows=tuple((name, figures_text(value)) for name, value in _errors(outcome, gain)),
    )
    above = gain.rmse_before**2 - gain.noise_floor**2
    share = (gain.rmse_before**2 - gain.rmse_after**2) / above if above > 0 else 0.0
    if outcome.causes and share > 0:
        yield Paragraph(
            f"The identified causes explain {percent_of_all(share)} of the mean square error above the noise "
            "floor."
        )


def errors_at_levels(gains: Sequence[Gain]) -> Iterable[Block]:
    """On whole amplitudes, rates and temperatures, where there are several."""
    if not gains:
        return
    yield Heading("Prediction error where the model extrapolates")
    yield Paragraph(
        "Each amplitude, rate or temperature was left out as a whole and predicted from the others."
    )
    yield Table(
        columns=(
            Column("Left out", grow=1),
            *(Column(words, "right") for words in ("As designed", "Calibrated", "With causes, arcsec rms")),
        ),
        rows=tuple(
            (
                capital(left_out_words(g.held_out)),
                *(figures_text(v) for v in (g.rmse_before, g.rmse_calibrated, g.rmse_after)),
            )
            for g in gains
        ),
    )  # fmt: skip


def _errors(outcome: DiagnosisOutcome, gain: Gain) -> Iterable[tuple[str, float]]:
    zeroed = ", zero offset fitted" if gain.unit == "arcsec" else ""
    yield f"Simulation as designed{zeroed}", gain.rmse_before
    yield f"{capital(calibrated_words(gain))}, no cause added", gain.rmse_calibrated
    if outcome.causes:
        yield "With the identified causes", gain.rmse_after
    if free := free_words(outcome):
        yield capital(free), gain.rmse_after
    yield f"{capital(noise_words(gain))}, the smallest error to expect", gain.noise_floor
