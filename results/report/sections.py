"""The report of a run, section by section: every word of it stands here, in limits or in tables."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain

from flexspline.results.file_names import CONVERGENCE
from flexspline.results.quantities import bounds_kind, quantity
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
GUARANTEED = bounds_kind(True)


def run_document(content: ReportContent) -> Document:
    """The whole report."""
    roomy = _letters(content) <= ROOMY
    sections = (
        (_summary(content), _asked(content), _answer(content)),
        (budget(content, roomy),),
        (whole_gear(content, roomy),),
        (_stress(content, roomy),),
        (_solver(content, roomy), _limits(content)),
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
            beside = row["alarm"] or "von Mises"
            tiles.append(Tile("Peak stress, wave generator", row["value"], row["unit"], beside))
    yield Tiles(tuple(tiles))
    yield Paragraph(totals_and_terms(content))


def _asked(content: ReportContent) -> Iterable[Block]:
    yield Heading("What was asked")
    yield Paragraph(
        plain("Torsional stiffness, stress, and backlash at the output between ")
        + symbol("−T_L")
        + plain(" and ")
        + symbol("+T_L")
        + plain(", ")
        + symbol("T_L")
        + plain(f"{NBSP}={NBSP}{content.design.load.torque_Nm:g}{NBSP}N·m, wave generator locked:")
    )
    yield Facts(tuple((name, value) for name, value in tables.design_facts(content.design)))


def _answer(content: ReportContent) -> Iterable[Block]:
    yield Heading("The answer")
    rows = [
        (
            (bold(a["name"]) if i == 0 else worded(a["name"]))
            + note(worded(a["note"]))
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
        caption=plain("Answers. Bounds of a stiffness are bounds of the discretisation error; ")
        + ref("solver")
        + plain(" says how they were found."),
        target="answers",
    )  # fmt: skip
    if fatigue := limits.fatigue(content):
        yield Paragraph(fatigue)
    if any(name.startswith("K_b_lobes") for name in content.stiffnesses):
        yield Paragraph(_which(content.design.solver.load_case))
    if count := len(content.warnings):
        said = "warning" if count == 1 else f"{count} warnings"
        yield Callout(
            "amber",
            text=bold(f"Read the {said} in ")
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
        *plain("Which stiffness of the flexspline to use: teeth bring the torque in at the two lobes, and "
               "the rim only rests on the wave generator, so "),
        *resting,
        *plain(" is nearest to a mounted gear. The uniform case is the stiffest; use it to compare parts. "),
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
    found = [
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
    if found:
        yield Heading("Stress and deformation")
        yield from found
        yield Paragraph(
            plain("Stresses are averaged at the nodes. Colours end at the peak that ")
            + ref("answers")
            + plain(
                " reports. Linear-elastic stress is singular at sharp edges, so no value is reported there; "
                "the places left out are named in "
            )
            + ref("limits")
            + plain(".")
        )


def _solver(content: ReportContent, roomy: bool) -> Iterable[Block]:
    yield Heading("Mesh and solver", "solver")
    yield from shown(
        content,
        roomy,
        Picture("flexspline_mesh", _mesh_of(content, "flexspline", "K_b")),
        Picture("shaft_mesh", _mesh_of(content, "output shaft", "K_e")),
    )
    solves = tables.solves(content)
    heads = ("Meshes", "Elements", "Unknowns", "Bounds", "Residual", "Energy – work")
    keys = ("meshes", "elements", "dofs", "half_width", "residual", "energy")
    yield Table(
        columns=(
            Column(""), Column("Model", grow=1), Column("Part solved", grow=1.2),
            *(Column(h, "right") for h in heads[:-1]), Column(heads[-1], "right", 0.9),
        ),
        rows=tuple(
            (symbol(s["symbol"]), s["model"], s["symmetry"], *(s[k] for k in keys)) for s in solves
        ),
        caption="How each stiffness was solved. Elements and unknowns are those of the finest mesh; "
        "“energy – work” is the relative difference of the stiffness from strain energy and from the "
        f"work of torque or loads; {tables.UNCHECKED} where a check was not made.",
    )  # fmt: skip
    for method, kind in dict.fromkeys((s["method"], s["kind"]) for s in solves):
        alike = [s for s in solves if (s["method"], s["kind"]) == (method, kind)]
        yield Paragraph(_bounds_of(content, method, alike))
    if not any(len(s.levels) > 1 for s in (content.K_b, content.K_e)):
        yield Paragraph(
            worded("K_b and K_e were solved on one mesh each, so there is no convergence to show.")
        )
    convergence = "Stiffness against the number of unknowns, as difference from the value reported."
    yield from shown(content, roomy, Picture(CONVERGENCE, convergence, 88))
    stages = content.stage_seconds or {}
    if stages:
        each = ", ".join(f"{name} {s:.1f} s" for name, s in stages.items())
        yield Paragraph(
            bold("Elapsed time:")
            + plain(
                f" {each}. Stages run side by side, so these do not add up; those read from the cache "
                "are not listed."
            )
        )


def _mesh_of(content: ReportContent, part: str, letter: str) -> Words:
    """A mesh's caption: which of the part's stiffnesses, whose names begin alike, are not from that mesh."""
    said = plain(f"Mesh of the {part} and its named surfaces.")
    own = {name: s for name, s in content.stiffnesses.items() if name.startswith(letter)}
    turned = [name for name, s in own.items() if s.model == "axisymmetric"]
    if not turned:
        return said
    return (
        said
        + plain(" ")
        + _listed(quantity(f"{name}_Nm_per_rad").symbol for name in turned)
        + plain(
            f" {'comes' if len(turned) == 1 else 'come'} from a mesh of the meridian; this one is for the "
            "pictures of stress"
            + (" and the other stiffnesses." if len(turned) < len(own) else ".")
        )
    )


def _bounds_of(content: ReportContent, method: str, these: list[tables.PrintedRow]) -> Words:
    said = (
        bold("Bounds of ") + _listed(s["symbol"] for s in these) + bold(": ") + plain(f"{method}. ")
    )
    if these[0]["kind"] == GUARANTEED:
        said += plain("These bounds hold without exception. ")
    else:
        said += plain("This is an estimate, not a guarantee. ")
    wide = [s["symbol"] for s in these if s["wide"]]
    said += plain(
        f"The wanted tolerance of ±{NBSP}{content.design.solver.tolerance_pct:g}{NBSP}% was "
    )
    return said + (plain("not met by ") + _listed(wide) + plain(".") if wide else plain("met."))


def _listed(symbols: Iterable[str]) -> Words:
    return tuple(chain.from_iterable(
        symbol(s) if i == 0 else plain(", ") + symbol(s) for i, s in enumerate(symbols)
    ))  # fmt: skip


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
