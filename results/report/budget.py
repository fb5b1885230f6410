"""The report's section on the backlash budget: the formula, its terms, and their charts."""

from __future__ import annotations

from collections.abc import Iterable

from flexspline.results.doubt import spread_sentence
from flexspline.results.quantities import quantity
from flexspline.results.report.content import ReportContent
from flexspline.results.report.document import (
    Block,
    Column,
    Formula,
    FormulaNode,
    Heading,
    Paragraph,
    Table,
)
from flexspline.results.report.picture_blocks import shown_charts
from flexspline.results.report.spans import Words, plain, symbol

EXTENDED = "extended.total_arcsec"
"""The sum's key in `result.json`."""
_DELTA: FormulaNode = ("symbol", "Δ_bl")
_SHAFT: FormulaNode = ("over", [("text", "2"), ("symbol", "T_L")], [("symbol", "K_e")])
_PLAY: FormulaNode = (
    "over",
    [("text", "2"), ("text", "("), ("symbol", "j_bn0"), ("text", "+"), ("symbol", "j′"), ("text", ")")],
    [("symbol", "m"), ("symbol", "z_1"), ("text", "cos"), ("symbol", "α")],
)  # fmt: skip
_CIRCLE = (
    plain(" / (")
    + symbol("m")
    + plain(" ")
    + symbol("z_1")
    + plain(" cos ")
    + symbol("α")
    + plain(")")
)


def _terms(content: ReportContent) -> dict[str, Words]:
    """Each term's formula, on one line."""
    return {
        "shaft": plain("2 ") + symbol("T_L") + plain(" / ") + symbol("K_e"),
        "flexspline": plain("2 ") + symbol("T_L") + plain(" / ") + symbol(content.sum_symbol),
        "flank_clearance": plain("2 ") + symbol("j_bn0") + _CIRCLE,
        "bearing_play": plain("2 ") + symbol("j′") + _CIRCLE,
        "total": symbol("Δ_bl"),
    }


def budget(content: ReportContent, roomy: bool) -> Iterable[Block]:
    """Formula, table, waterfall and torque–angle line."""
    yield Heading("The backlash budget", "budget")
    yield Paragraph(
        plain(
            "Backlash is the wind-up of shaft and flexspline between the two torques plus the angle "
            "that flank clearance "
        )
        + symbol("j_bn0")
        + plain(" and bearing play leave free:")
    )
    plus: FormulaNode = ("text", "+")
    K_b = content.sum_symbol
    flexspline: FormulaNode = ("over", [("text", "2"), ("symbol", "T_L")], [("symbol", K_b)])
    yield Formula(
        (_DELTA, ("text", "="), _SHAFT, plus, flexspline, plus, _PLAY),
        f"Δ_bl = 2 T_L / K_e + 2 T_L / {K_b} + 2 (j_bn0 + j′) / (m z_1 cos α)",
    )
    total = content.backlash.total_arcsec
    formulas, rows = _terms(content), []
    for term, value in {**content.backlash.terms_arcsec, "total": total}.items():
        entry, share = quantity(f"backlash_arcsec.{term}"), f"{100 * value / total:.0f} %"
        rows.append((entry.name, formulas[term], entry.text(value), entry.unit, share))
    yield Table(
        columns=(
            Column("Term", grow=1), Column("Formula"), Column("Value", "right"), Column("Unit"),
            Column("Share", "right"),
        ),
        rows=tuple(rows),
        caption=f"The four terms and their sum; {spread_sentence(content.backlash)}.",
        strong=len(rows) - 1,
    )  # fmt: skip
    if content.extended is not None:
        model, extended = content.extended.model, content.extended.total_arcsec
        more, text = extended - total, quantity(EXTENDED).text
        yield Paragraph(
            plain(
                f"With the extended model in {model} the backlash is {text(extended)} arcsec: the measured "
                f"stiffness and gap, and the identified causes, {'add' if more >= 0 else 'subtract'} "
                f"{text(abs(more))} arcsec. No standard deviation is computed for this sum."
            )
        )
    yield from shown_charts(content, roomy, "budget")
