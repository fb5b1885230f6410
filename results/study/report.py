"""The report of a study, section by section."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from pathlib import Path

from pipeline.study.evaluate import LOBE_TOLERANCE, TORSION_TOLERANCE
from pipeline.study.holes import DRIFT, pierced
from pipeline.study.mass import DENSITY_KG_M3
from pipeline.study.result import StudyResult
from pipeline.study.scatter import Scatter
from results.atomic import write_bytes
from results.records import program_version
from results.report.both import reports_of
from results.report.document import (
    Block,
    Bullets,
    Column,
    Document,
    Heading,
    Paragraph,
    Picture,
    Pictures,
    Table,
)
from results.report.spans import Text, alarm
from results.study.labels import entry
from results.study.why import failures, influences, limits, signed, unfollowed

COLUMNS = 5
"""Best designs side by side."""
METHODS = {
    "grid": "Every combination of the given values.",
    "sobol": "Designs spread evenly by a scrambled Sobol sequence.",
    "optimize": "Designs chosen by an optimiser that learns from those before.",
    "tolerance": "Scatter of uncertainty and tolerances through the whole chain (Saltelli's scheme).",
}
WIDTHS = {"pareto.png": 75, "best.png": 48, "convergence.png": 75, "parallel.png": 88}
"""Percent of the page's width."""
CAPTIONS = {
    "pareto.png": "Every design built, and the front that none beats.",
    "parallel.png": "Every design as a line over the varied dimensions and the objectives.",
    "convergence.png": "Every design in the order chosen, and the best so far.",
    "best.png": "The best designs in section.",
    "tolerance.png": "Distribution, Sobol indices, and what tighter tolerances buy.",
}


def write_study_reports(folder: Path, result: StudyResult, pictures: Sequence[Path]) -> list[Path]:
    """Write report.pdf and report.html, each whole or not at all; their paths.

    Raises
    ------
    ReportError : typst refused the document.
    """
    document = study_document(result, [p.name for p in pictures])
    made = reports_of(document, {p.stem: p for p in pictures})
    for name, data in made.items():
        write_bytes(folder / name, data)
    return [folder / name for name in made]


def study_document(result: StudyResult, pictures: Sequence[str]) -> Document:
    """The report; `pictures` are the names of the files drawn."""
    study = result.study
    blocks = (
        Paragraph(f"{METHODS[study.file.run.method]} {_counts(result)}"),
        *_best(result),
        *_why(result),
        *_verified(result),
        *chain.from_iterable(_scatter(s) for s in result.scatter),
        *(_picture(n) for n in pictures),
        *_failures(result),
        Heading("What holds"),
        Bullets(tuple(_notes(result))),
    )
    return Document(
        title="A study of designs",
        running="Study",
        name=study.design.name,
        heading=f"{study.name} · {study.design.name}",
        issued=f"flexspline {program_version()}",
        blocks=blocks,
    )


def _picture(name: str) -> Block:
    caption = CAPTIONS.get(name, CAPTIONS["tolerance.png"])
    return Pictures((Picture(Path(name).stem, caption, WIDTHS.get(name, 100)),))


def _why(result: StudyResult) -> Iterable[Block]:
    if why := (*influences(result), *limits(result)):
        yield Heading("Why they win")
        yield Bullets(why)


def _failures(result: StudyResult) -> Iterable[Block]:
    if failed := tuple(failures(result)):
        yield Heading("Designs without figures")
        yield Bullets(failed)


def _counts(result: StudyResult) -> str:
    said = f"{len(result.built)} of {len(result.rows)} designs were built and solved"
    if result.study.file.constraint:
        said += f"; {len(result.feasible)} of them keep to every constraint"
    return said + "."


def _best(result: StudyResult) -> Iterable[Block]:
    """A line per varied key and figure: name, then the best designs' values."""
    file = result.study.file
    chosen = () if result.scatter else result.best(COLUMNS)
    if not chosen:
        return
    lines: list[tuple[str, ...]] = []
    for key in file.vary:
        q = entry(key)
        lines.append((q.axis, *(q.text(r.values[key]) for r in chosen)))
    for key in dict.fromkeys([*file.objective, *file.constraint, "flexspline_mass_g"]):
        q = entry(key)
        if all(key in r.outcome.figures for r in chosen):
            lines.append((q.axis, *(q.text(r.outcome.figures[key]) for r in chosen)))
    yield Heading("The best designs")
    yield Table(
        (Column("", grow=1), *(Column(f"design {r.slot}", "right") for r in chosen)), tuple(lines)
    )


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
        yield Heading("The fast model against the solid one")
        yield Table(
            (
                Column("Design"), Column("Figure", grow=1), Column("Fast", "right"),
                Column("Solid", "right"), Column("Verdict"),
            ),
            tuple(lines),
        )  # fmt: skip


def _scatter(s: Scatter) -> Iterable[Block]:
    q = entry(s.key)
    sentence = (
        f"{q.name}: mean {q.with_unit(s.mean)}, standard deviation {q.with_unit(s.std)}, 95 % from "
        f"{q.range_text(s.low, s.high)} {q.unit}. The quadratic surface behind the last four columns "
        f"misses {s.surface_rms:.2g} {q.unit} (root mean square)."
    )
    if s.dropped:
        sentence += f" {s.dropped} sample blocks with a design that cannot be built are left out."
    heads = ("Sobol, first", "Sobol, total", "× 0.75", "× 0.5", "× 0.25", "perfect")
    yield Heading("What scatters, and what a tighter tolerance buys")
    yield Paragraph(sentence)
    yield Table(
        (Column("Input", grow=1), Column("Value"), *(Column(h, "right") for h in heads)),
        tuple(_inputs(s)),
    )
    yield Paragraph(
        f"The last four columns say by how many {q.unit} the 95 % range gets narrower when that input "
        "alone scatters less."
    )


def _inputs(s: Scatter) -> Iterable[tuple[str, ...]]:
    """A line for each input, the most important first."""
    for i in sorted(range(len(s.inputs)), key=lambda i: -s.indices.total[i]):
        x = s.inputs[i]
        bought = {t.factor: t.bought for t in s.tightened if t.key == x.key}
        unit = entry(x.key)
        spread = x.std if x.normal else x.high - x.nominal
        kind = "s =" if x.normal else "±"
        yield (
            unit.name, f"{unit.text(x.nominal)}, {kind} {unit.with_unit(spread)}",
            f"{s.indices.first[i]:.2f} ± {s.indices.first_conf[i]:.2f}",
            f"{s.indices.total[i]:.2f} ± {s.indices.total_conf[i]:.2f}",
            *(f"{max(0.0, bought[f]):.1f}" for f in (0.75, 0.5, 0.25, 0.0)),
        )  # fmt: skip


def _holes(result: StudyResult) -> Iterable[str]:
    """How K_b and K_e were corrected for holes and keyway, and what that does to their bounds."""
    pierced_ones = pierced(result.study.design)
    factors = {
        k: next((r.outcome.figures[f] for r in result.built if f in r.outcome.figures), None)
        for k, f in ((k, f"{k}_holes_factor") for k in pierced_ones)
    }
    used = {k: f for k, f in factors.items() if f is not None}
    if used:
        said = " and ".join(f"{k} by {signed(100 * (f - 1), 1)} %" for k, f in used.items())
        yield (
            f"Holes and keyway change {said} in the design that the study began with (one solid solve). "
            "Every design's K is corrected by that; its bounds are widened by what both solves leave open "
            f"and by {100 * DRIFT:g} % of the correction, and are estimates. Lobes and stresses are not "
            "corrected."
        )
    if missing := [k for k in pierced_ones if k not in used]:
        yield (
            f"{' and '.join(missing)}: of the part without its holes or keyway, since the solid solve "
            "that would tell their effect failed."
        )
    if keys := unfollowed(result.study):
        yield f"{keys}: the fast model does not follow these; mass does, and run.verify solves them."


def _notes(result: StudyResult) -> list[str]:
    notes = [
        f"Fast model: the axisymmetric one of the same meridian, without bolt holes and keyway; there K "
        f"is between bounds at most {100 * TORSION_TOLERANCE:g} % apart, lobes "
        f"{100 * LOBE_TOLERANCE:g} %.",
        *_holes(result),
        f"Mass at {DENSITY_KG_M3:g} kg/m³ (steel), since the design file has no density.",
    ]
    if not result.verified:
        notes.append("No design was solved again with the solid model (run.verify = 0).")
    return notes
