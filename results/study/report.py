"""The report of a study, section by section."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from pathlib import Path

from flexspline.geometry.listed import listed
from flexspline.geometry.percent import percent
from flexspline.pipeline.stress_limits import ON_ELLIPSE
from flexspline.pipeline.study.evaluate import STUDY_STRESS_TOLERANCE
from flexspline.pipeline.study.result import StudyResult
from flexspline.results.atomic import write_together
from flexspline.results.file_names import BEST_STRESS
from flexspline.results.report.attached import Attachment
from flexspline.results.report.both import reports_of
from flexspline.results.report.document import (
    Block,
    Bullets,
    Callout,
    Column,
    Document,
    Heading,
    Paragraph,
    Picture,
    Pictures,
    Table,
)
from flexspline.results.report.issued import issued
from flexspline.results.report.spans import Text, alarm, bold, plain, worded
from flexspline.results.study.best_figure import DRAWN_DESIGNS
from flexspline.results.study.best_stress import NOTHING_DRAWN, VIEW, BestStress
from flexspline.results.study.design_table import design_table
from flexspline.results.study.failures import LISTED_REASONS, causes, further_reasons
from flexspline.results.study.labels import entry
from flexspline.results.study.notes import notes
from flexspline.results.study.question import question
from flexspline.results.study.scatter_section import scatter_section
from flexspline.results.study.unbeaten import unbeaten_start
from flexspline.results.study.why import (
    disagreement,
    incomplete,
    influences,
    limits,
    misses,
)

METHODS = {
    "grid": "Every combination of the given values.",
    "sobol": "Designs spread evenly by a scrambled Sobol sequence.",
    "optimize": "Designs chosen by an optimiser that learns from the earlier designs.",
    "tolerance": "Scatter from uncertainty and tolerances through the whole analysis, by Saltelli's scheme.",
}
WIDTHS = {
    "pareto.png": 75, "best.png": 78, BEST_STRESS: 75, "convergence.png": 75, "parallel.png": 88,
    "sweep.png": 80,
}  # fmt: skip
"""Percent of the page's width."""
CAPTIONS = {
    "pareto.png": "Every design that was built, and the Pareto front.",
    "parallel.png": "Every design as a line over the varied dimensions and its figures{bars}.",
    "sweep.png": "Figures over the varied dimension; the curve is broken where a design could not be built. "
    "study.csv has every figure.",
    "convergence.png": "Every design in the order chosen{best_so_far}.",
    "best.png": "{sections} in section, drawn over the start design.",
    BEST_STRESS: "Design {first} on the wave generator, as flexspline run computes it{peaks}.",
    "tolerance.png": "Distribution; Sobol indices and how much tighter tolerances narrow the 95 % range, "
    "where known.",
}


def write_study_reports(
    folder: Path,
    result: StudyResult,
    pictures: Sequence[Path],
    best: BestStress = NOTHING_DRAWN,
    attached: tuple[Attachment, ...] = (),
    of_designs: Sequence[str] = (),
) -> list[Path]:
    """Write report.pdf and report.html, each whole or not at all; their paths.

    With `best` its picture turns in the browser, or the report says why it is missing; `of_designs` are the
    warnings of the designs themselves.

    Raises
    ------
    ReportError : typst refused the document.
    """
    document = study_document(result, [p.name for p in pictures], attached, best, of_designs)
    made = reports_of(document, {p.stem: p for p in pictures}, best.views)
    return write_together(folder, made)


def study_document(
    result: StudyResult,
    pictures: Sequence[str],
    attached: tuple[Attachment, ...] = (),
    best: BestStress = NOTHING_DRAWN,
    of_designs: Sequence[str] = (),
) -> Document:
    """The report; `pictures` are the names of the files drawn; the rest is as of `write_study_reports`."""
    study = result.study
    blocks = (
        Paragraph(f"{METHODS[study.file.run.method]} {_counts(result)}"),
        *question(study),
        *design_table(result),
        *_why(result),
        *_verified(result),
        *((Paragraph(f"No distribution: {result.unscattered}."),) if result.unscattered else ()),
        *chain.from_iterable(scatter_section(s) for s in result.scatter),
        *(_picture(n, result, best.peak_MPa) for n in pictures),
        *(_not_drawn(best.missing, result) if best.missing and not best.picture else ()),
        *_failures(result),
        Heading("Scope and limits"),
        Bullets(tuple(map(worded, notes(result, of_designs)))),
    )
    return Document(
        title="A study of designs",
        running="Study",
        name=study.design.name,
        heading=f"{study.name} · {study.design.name}",
        issued=issued(),
        attached=attached,
        blocks=blocks,
    )


def _picture(name: str, result: StudyResult, best_peak_MPa: float | None) -> Block:
    first = result.pareto[0].slot if name == BEST_STRESS else ""
    so_far = ", and the best so far" if result.feasible else "; none meets every constraint"
    bars = "; a bar marks the range that a constraint allows" * bool(result.study.file.constraint)
    caption = CAPTIONS.get(name, CAPTIONS["tolerance.png"]).format(
        first=first,
        best_so_far=so_far,
        sections=_sections(result),
        bars=bars,
        peaks=_peaks(result, best_peak_MPa) if name == BEST_STRESS else "",
    )
    view = VIEW if name == BEST_STRESS else ""
    return Pictures((Picture(Path(name).stem, caption, WIDTHS.get(name, 100), view),))


def _peaks(result: StudyResult, drawn_MPa: float | None) -> str:
    """The peak in the picture of the first design, and the study's own of the same design."""
    key = f"{ON_ELLIPSE}_mises_MPa"
    row, stress = result.pareto[0], entry(key)
    text = "" if drawn_MPa is None else f": peak {stress.with_unit(drawn_MPa)}"
    own = row.outcome.figures.get(key)
    if own is None:
        return text
    holes = " leaves out bolt holes and" if result.design_of(row).flexspline.bolt_count else ""
    return (
        f"{text}. The study itself has {stress.with_unit(own)} for this design: its "
        f"model{holes} is solved to {percent(STUDY_STRESS_TOLERANCE)}"
    )


def _sections(result: StudyResult) -> str:
    slots = [str(row.slot) for row in result.best(DRAWN_DESIGNS)]
    return f"Design{'s' * (len(slots) > 1)} {listed(slots, 'designs')}"


def _not_drawn(reason: str, result: StudyResult) -> Iterable[Block]:
    caption = f"Design {result.pareto[0].slot} on the wave generator."
    yield Callout("amber", text=bold("Not drawn: ") + plain(f"{reason}."), items=(caption,))


def _why(result: StudyResult) -> Iterable[Block]:
    if missed := tuple(misses(result)):
        yield Heading("No design meets every constraint")
        yield Bullets(missed)
    if why := (*unbeaten_start(result), *influences(result), *limits(result)):
        yield Heading("Why they are best" if result.pareto else "Effects of the varied dimensions")
        yield Bullets(why)


def _failures(result: StudyResult) -> Iterable[Block]:
    reasons = causes(result)
    if not reasons:
        return
    yield Heading("What could not be built or solved")
    lines = tuple((str(r.designs), r.name, r.example_words) for r in reasons[:LISTED_REASONS])
    columns = (Column("Designs", "right"), Column("Cause", grow=1), Column("Example", grow=2))
    yield Table(columns, lines)
    yield Paragraph(f"A design may have several causes. {further_reasons(reasons)}".strip())


def _counts(result: StudyResult) -> str:
    text = f"{len(result.built)} of {len(result.rows)} designs were built and solved"
    if result.study.file.constraint:
        text += f"; {len(result.feasible)} of them meet every constraint"
    if result.incomplete:
        text += f"; {incomplete(result)}"
    return text + "."


def _verified(result: StudyResult) -> Iterable[Block]:
    lines: list[tuple[Text, ...]] = []
    for v in result.verified:
        if v.reason:
            lines.append((f"design {v.slot}", v.reason, "", "", "failed"))
        for c in v.checks:
            q = entry(c.key)
            lines.append((
                f"design {v.slot}", q.axis,
                q.range_text(*c.fast_bounds) if c.fast_bounds else q.text(c.fast),
                q.range_text(*c.solid_bounds) if c.solid_bounds else q.text(c.solid),
                "agree" if c.agrees else alarm("ALARM"),
            ))  # fmt: skip
    if lines:
        yield Heading("The fast model compared with the solid one")
        yield Table(
            (
                Column("Design"), Column("Figure", grow=1), Column("Fast", "right"),
                Column("Solid", "right"), Column("Verdict"),
            ),
            tuple(lines),
        )  # fmt: skip
    wrong = (c for v in result.verified for c in v.checks if not c.agrees)
    if reasons := tuple(dict.fromkeys(map(disagreement, wrong))):
        yield Bullets(tuple((*alarm("ALARM"), *plain(f": {why}.")) for why in reasons))
