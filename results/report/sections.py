"""The report of a run, section by section: its words stand here, in this folder's other files and, below a
chart, in the file that draws it."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain

from flexspline.results.quantities import quantity
from flexspline.results.report import limits, tables
from flexspline.results.report.budget import budget
from flexspline.results.report.content import ReportContent
from flexspline.results.report.dimensions import dimensions
from flexspline.results.report.document import (
    Block,
    Break,
    Callout,
    Column,
    Document,
    Facts,
    Heading,
    Paragraph,
    Picture,
    Table,
    Tile,
    Tiles,
)
from flexspline.results.report.issued import issued
from flexspline.results.report.mesh_and_solver import mesh_and_solver
from flexspline.results.report.picture_blocks import shown
from flexspline.results.report.spans import (
    NBSP,
    Words,
    alarm,
    bold,
    note,
    plain,
    ref,
    symbol,
    worded,
)
from flexspline.results.report.totals import totals_and_terms
from flexspline.results.report.whole_gear import whole_gear

ROOMY = 1200
"""Letters of free text (names, warnings, stages) up to which sections begin on new pages: beyond,
they follow each other and the report stays within nine pages."""


def run_document(content: ReportContent) -> Document:
    """The whole report."""
    roomy = _letters(content) <= ROOMY
    sections = (
        (_summary(content), _task(content), _answer(content)),
        (budget(content, roomy),),
        (whole_gear(content, roomy),),
        (_stress(content, roomy),),
        (mesh_and_solver(content, roomy), _limits(content)),
    )
    blocks: list[Block] = []
    for pages in sections:
        made = list(chain.from_iterable(pages))
        if blocks and made and roomy:
            blocks.append(Break())
        blocks += made
    return Document(
        title="Stiffness and backlash of a strain wave gear",
        running="Stiffness and backlash report",
        name=content.design.name,
        issued=issued(content.version),
        blocks=tuple(blocks),
        numbered=True,
        attached=content.attached,
    )


def _letters(content: ReportContent) -> int:
    design = content.design
    names = [design.name, design.material.flexspline.name, design.part("shaft").material.name]
    return sum(map(len, [*names, *content.warnings, *(content.stage_seconds or {})]))


def _summary(content: ReportContent) -> Iterable[Block]:
    total, series, *rest = tables.answers(content)
    wave = quantity("wave_generator_peak_mises_MPa").symbol
    tiles = [
        Tile("Backlash", total["value"], total["unit"], total["bounds"]),
        Tile(
            "Series stiffness",
            series["value"],
            series["unit"],
            f"{series['bounds']}, {series['kind']}",
        ),
    ]
    for row in rest:
        if row["symbol"] == wave:
            tiles.append(
                Tile("Peak stress, wave generator", row["value"], row["unit"], row["tile"])
            )
    yield Tiles(tuple(tiles))
    yield Paragraph(totals_and_terms(content))


def _task(content: ReportContent) -> Iterable[Block]:
    yield Heading("The task")
    yield Paragraph(
        plain("Torsional stiffness, stress, and backlash at the output between ")
        + symbol("−T_L")
        + plain(" and ")
        + symbol("+T_L")
        + plain(", ")
        + symbol("T_L")
        + plain(f"{NBSP}={NBSP}{content.design.load.torque_Nm:g}{NBSP}N·m, wave generator locked:")
    )
    yield Facts(tables.design_facts(content.design))


def _answer(content: ReportContent) -> Iterable[Block]:
    yield Heading("The results")
    rows = [
        (
            (bold(a["name"]) if i == 0 else worded(a["name"]))
            + (note(worded(a["note"])) if a["note"] else ())
            + (note(alarm(a["alarm"])) if a.get("alarm") else ()),
            symbol(a["symbol"]),
            bold(a["value"]),
            a["unit"],
            plain(a["bounds"] or "–") + (note(plain(a["kind"])) if a.get("kind") else ()),
        )
        for i, a in enumerate(tables.answers(content))
    ]
    yield Table(
        columns=(
            Column("Quantity", grow=1), Column("Symbol"), Column("Value", "right"), Column("Unit"),
            Column("Bounds"),
        ),
        rows=tuple(rows),
        caption=plain("Results. The bounds of a stiffness limit the discretisation error; ")
        + ref("solver")
        + plain(" says how they were obtained."),
        target="answers",
    )  # fmt: skip
    if fatigue := limits.fatigue(content):
        yield Paragraph(fatigue)
    if any(name.startswith("K_b_lobes") for name in content.stiffnesses.solved):
        yield Paragraph(_which(content.design.solver.load_case))
    if count := len(content.warnings):
        warnings = "warning" if count == 1 else f"{count} warnings"
        yield Callout(
            "amber",
            text=bold(f"Read the {warnings} in ")
            + ref("warnings")
            + bold(" before using these figures."),
        )


def _which(load_case: str) -> Words:
    """Which of the flexspline's stiffnesses is for what."""
    resting, free = (
        symbol(quantity(f"K_b_lobes_{case}_Nm_per_rad").symbol)
        for case in ("contact", "unsupported")
    )
    return (
        *plain("Which stiffness of the flexspline to use: the torque enters through the teeth at the two "
               "lobes, and the rim may lift off the wave generator, so "),
        *resting,
        *plain(" is closest to a mounted gear. The uniform case is the stiffest; use it to compare parts. "),
        *free,
        *plain(" shows how much the wave generator carries. No case includes teeth, wave-generator bearing "
               f"and bolts. The backlash sum uses the case “{load_case}” (solver.load_case)."),
    )  # fmt: skip


def _stress(content: ReportContent, roomy: bool) -> Iterable[Block]:
    under = plain(", von Mises stress under ") + symbol("T_L")
    at = plain(f"{NBSP}={NBSP}{content.design.load.torque_Nm:g}{NBSP}N·m.")
    ellipse = (
        "Flexspline on the wave generator: the ellipse, magnified as stated in the picture, with its "
        "von Mises stress."
    )
    pictures = [
        *shown(
            content,
            roomy,
            Picture(
                "flexspline_torque", plain("Flexspline") + under + at, view="flexspline_torque"
            ),
            Picture("shaft_torque", plain("Output shaft") + under + at, view="shaft_torque"),
        ),
        *shown(content, roomy, Picture("wave_generator", ellipse, 90, "wave_generator")),
    ]
    if pictures:
        yield Heading("Stress and deformation")
        yield from pictures
        yield Paragraph(
            plain(
                "Stresses are averaged at the nodes. The colour scale ends at the peak stress of "
            )
            + ref("answers")
            + plain(
                ". Linear-elastic stress is singular at sharp edges, so no value is reported there; "
            )
            + ref("limits")
            + plain(" lists the excluded places.")
        )


def _limits(content: ReportContent) -> Iterable[Block]:
    yield Heading("Assumptions and their limits", "limits")
    for heading, text in limits.assumptions(content):
        yield Paragraph(bold(f"{heading}. ") + worded(text))
    if content.warnings:
        yield Heading("Warnings", "warnings")
        yield Callout("amber", items=tuple(map(worded, content.warnings)))
    yield from dimensions(content.design)
    if content.versions:
        yield Heading("Versions")
        pairs = {"flexspline": content.version, **content.versions}
        yield Paragraph(", ".join(f"{name} {v}" for name, v in pairs.items()) + ".")
