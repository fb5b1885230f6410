"""The report's section on meshes and solver: how each stiffness was found, and how well it is known."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain

from flexspline.results.quantities import bounds_kind, quantity
from flexspline.results.report import tables
from flexspline.results.report.content import ReportContent
from flexspline.results.report.document import (
    Block,
    Bullets,
    Column,
    Heading,
    Paragraph,
    Picture,
    Table,
)
from flexspline.results.report.picture_blocks import shown, shown_charts
from flexspline.results.report.spans import NBSP, Words, bold, plain, symbol, worded
from flexspline.results.sentences import capital

GUARANTEED = bounds_kind(True)


def mesh_and_solver(content: ReportContent, roomy: bool) -> Iterable[Block]:
    """Pictures of the meshes, the table of solves, what each one's bounds are, and the time."""
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
        "work of torque or loads. The residual is relative: a direct solver "
        "leaves rounding errors, an iterative one stops earlier. "
        f"“{tables.UNCHECKED}” means not checked.",
    )  # fmt: skip
    for method, kind in dict.fromkeys((s["method"], s["kind"]) for s in solves):
        alike = [s for s in solves if (s["method"], s["kind"]) == (method, kind)]
        steps, sure = steps_of(method), _how_sure(content, alike)
        yield Paragraph(sure if len(steps) > 1 else sure + plain(f" {steps[0]}"))
        if len(steps) > 1:
            yield Bullets(tuple(map(plain, steps)), small=True)
    if not any(len(s.levels) > 1 for s in (content.stiffnesses.K_b, content.stiffnesses.K_e)):
        yield Paragraph(
            worded("K_b and K_e were solved on one mesh each, so there is no convergence to show.")
        )
    yield from shown_charts(content, roomy, "solver")
    stages = content.stage_seconds or {}
    if stages:
        times = "; ".join(f"{name} {s:.1f} s" for name, s in stages.items())
        yield Paragraph(
            bold("Elapsed time:")
            + plain(
                f" {times}. Stages run in parallel, so these times do not add up; stages read from the cache "
                "are not listed."
            )
        )


def _mesh_of(content: ReportContent, part: str, letter: str) -> Words:
    """A mesh's caption: which of the part's stiffnesses, whose names begin alike, are not from that mesh."""
    caption = plain(f"Mesh of the {part} and its named surfaces.")
    solved = {name: s for name, s in content.stiffnesses.solved.items() if name.startswith(letter)}
    turned = [name for name, s in solved.items() if s.model == "axisymmetric"]
    if not turned:
        return caption + plain(
            " The stress picture is of this mesh; it may be finer than that of the stiffness."
        )
    return (
        caption
        + plain(" ")
        + _listed(quantity(f"{name}_Nm_per_rad").symbol for name in turned)
        + plain(
            f" {'comes' if len(turned) == 1 else 'come'} from a mesh of the meridian; this mesh is for the "
            "stress pictures"
            + (" and the other stiffnesses." if len(turned) < len(solved) else ".")
        )
    )


def steps_of(method: str) -> tuple[str, ...]:
    """The steps of a method, each a sentence: semicolons stand between them, and within brackets.

    >>> steps_of("by energy (above; below); K is the upper one")
    ('By energy (above; below).', 'K is the upper one.')
    """
    steps, depth = [""], 0
    for letter in method:
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if letter == ";" and depth == 0:
            steps.append("")
        else:
            steps[-1] += letter
    return tuple(f"{capital(step.strip())}." for step in steps)


def _how_sure(content: ReportContent, these: list[tables.PrintedRow]) -> Words:
    """Whose bounds they are, whether they are proven, and whether they are as narrow as was asked for."""
    proven = these[0]["kind"] == GUARANTEED
    text = (
        bold("Bounds of ")
        + _listed(s["symbol"] for s in these)
        + bold(": ")
        + plain("These bounds are proven. " if proven else "This is an estimate, not a guarantee. ")
        + plain(
            f"The requested tolerance of ±{NBSP}{content.design.solver.tolerance_pct:g}{NBSP}% was "
        )
    )
    wide = [s["symbol"] for s in these if s["wide"]]
    return text + (plain("not met by ") + _listed(wide) + plain(".") if wide else plain("met."))


def _listed(symbols: Iterable[str]) -> Words:
    return tuple(chain.from_iterable(
        symbol(s) if i == 0 else plain(", ") + symbol(s) for i, s in enumerate(symbols)
    ))  # fmt: skip
