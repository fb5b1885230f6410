"""The report of a diagnosis, section by section."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Literal

from flexspline.geometry.listed import listed
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome, NamedCause, Unexplained
from flexspline.pipeline.stiffness_pair import StiffnessPair
from flexspline.results.diagnosis.advice import why
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.diagnosis.data_used import calibrated_sentences, own_slope
from flexspline.results.diagnosis.notes import notes
from flexspline.results.diagnosis.structure_words import structure_words
from flexspline.results.diagnosis.summary import summary, verdict_heading
from flexspline.results.diagnosis.words import (
    cause_title,
    magnitude_words,
    odds_words,
    sure_words,
    title_of,
)
from flexspline.results.figures.diagnosis.draw import DiagnosisFigure
from flexspline.results.numbers import figures_text, grouped
from flexspline.results.report.attached import Attachment
from flexspline.results.report.compared import compared, measured
from flexspline.results.report.document import (
    Block,
    Break,
    Bullets,
    Callout,
    Column,
    Document,
    Facts,
    Heading,
    Paragraph,
    Picture,
    Pictures,
    Table,
)
from flexspline.results.report.errors_held_out import errors_at_levels, errors_held_out
from flexspline.results.report.issued import issued
from flexspline.results.report.spans import Text, bold, code, note, plain, worded
from flexspline.results.sentences import capital, sentence

OPEN = ("ambiguous", "unknown", "insufficient")
"""Verdicts that leave something to do."""


def diagnosis_document(
    diagnosis: Diagnosis,
    figures: Sequence[DiagnosisFigure],
    used: StiffnessPair,
    attached: tuple[Attachment, ...] = (),
) -> Document:
    """The report; its figures go by the stems of their files."""
    blocks = (
        *_verdict(diagnosis, used),
        *_causes(diagnosis.outcome),
        *_unexplained(diagnosis.outcome.unexplained),
        *errors_held_out(diagnosis.outcome),
        *_after(diagnosis),
        *errors_at_levels(diagnosis.outcome.gains_at_levels),
        *_figures(figures[:1]),
        *_model(diagnosis),
        *_notes(diagnosis),
        *_figures(figures[1:]),
    )
    return Document(
        title="The simulation against a measurement",
        running="Measured against simulated",
        name=diagnosis.design.name,
        issued=issued(),
        attached=attached,
        blocks=blocks,
    )


def _verdict(diagnosis: Diagnosis, used: StiffnessPair) -> Iterable[Block]:
    outcome = diagnosis.outcome
    tone: Literal["amber", "blue"] = "amber" if outcome.verdict in OPEN else "blue"
    yield Callout(tone, verdict_heading(diagnosis), summary(diagnosis))
    yield Heading("What was measured")
    facts = tuple((name, fact) for name, fact in measured(diagnosis))
    yield Facts((*facts, ("SHA-256", code(diagnosis.measurement.read_as.sha256))))
    yield Paragraph(worded(compared(diagnosis, used)))
    if diagnosis.calibration is not None:
        sentence = calibrated_sentences(
            diagnosis.calibration, diagnosis.prediction, outcome, own_slope(diagnosis)
        )
        yield Paragraph(worded(sentence))


def _causes(outcome: DiagnosisOutcome) -> Iterable[Block]:
    if not outcome.causes:
        return
    may = outcome.verdict == "ambiguous"
    yield Heading(f"What {'may be' if may else 'is'} missing from the simulation")
    yield Table(
        columns=(
            Column("Cause", grow=1.35), Column("Magnitude"), Column("Confidence"),
            Column("Alternatives", grow=1.2),
        ),
        rows=tuple(_cause(c) for c in outcome.causes),
    )  # fmt: skip
    yield Paragraph(
        "± is one standard deviation; two standard deviations cover 95 of 100 cases. The odds compare the "
        "best explanation with this cause and the best explanation without it.",
        small=True,
    )


def _cause(cause: NamedCause) -> tuple[Text, ...]:
    units = listed(cause.own_units, "units")
    odds = "" if cause.alternatives else odds_words(cause.evidence_nats)
    others = ", ".join(map(title_of, cause.alternatives))
    return (
        bold(capital(cause_title(cause))) + (note(f"unit {units}") if units else ()),
        magnitude_words(cause),
        plain(sure_words(cause)) + (note(odds) if odds else ()),
        capital(others) or "No other known cause",
    )


def _unexplained(left: Sequence[Unexplained]) -> Iterable[Block]:
    if not left:
        return
    yield Heading("What no known cause explains")
    yield Table(
        columns=(
            Column("Channel"), Column("Form", grow=1), Column(f"Size, {left[0].unit} rms"),
            Column("Probability by chance"),
        ),
        rows=tuple(
            (
                capital(channel_words(u.channel)),
                capital(structure_words(u)),
                figures_text(u.rms, 2),
                "less than 1 in a million" if u.p_value < 1e-6 else f"1 in {grouped(1 / u.p_value, 0)}",
            )
            for u in left
        ),
    )  # fmt: skip


def _after(diagnosis: Diagnosis) -> Iterable[Block]:
    after = diagnosis.outcome.next_measurement
    if after is not None:
        yield Heading("What to measure next")
        yield Paragraph(
            bold(f"{capital(channel_words(after.vary))}. ")
            + plain(sentence(why(after, diagnosis.kind, diagnosis.causes)))
        )


def _figures(figures: Sequence[DiagnosisFigure]) -> Iterable[Block]:
    if figures:
        yield Break()
    for f in figures:
        yield Pictures((Picture(f.path.stem, f.caption, 86),))


def _model(diagnosis: Diagnosis) -> Iterable[Block]:
    if diagnosis.model is None:
        return
    added = " with these causes added" if diagnosis.outcome.causes else ""
    yield Heading("The extended model")
    yield Paragraph(
        code("extended_model.toml")
        + plain(
            f" beside this report contains the calibrated simulation{added}. This command computes the angle "
            "for any torque history:"
        )
    )
    yield Paragraph(code("flexspline predict DESIGN.toml --model extended_model.toml TORQUE.csv"))


def _notes(diagnosis: Diagnosis) -> Iterable[Block]:
    lines = notes(diagnosis)
    if lines:
        yield Heading("Notes")
        yield Bullets(tuple(map(capital, lines)), small=True)
