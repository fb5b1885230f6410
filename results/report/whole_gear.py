"""The report's section on the whole gear: its curve, its shares, and a comparison with the sum."""

from __future__ import annotations

from collections.abc import Iterable

from flexspline.geometry.errors import plain_number
from flexspline.pipeline.backlash import Backlash
from flexspline.pipeline.gear.gear_curve import GearCurve
from flexspline.pipeline.gear.gear_terms import TIGHT
from flexspline.results.gear_terms import term_names
from flexspline.results.gear_words import gear_notes, gear_warnings
from flexspline.results.numbers import grouped
from flexspline.results.quantities import quantities_of, quantity
from flexspline.results.report.content import ReportContent
from flexspline.results.report.document import (
    Block,
    Callout,
    Column,
    Heading,
    Paragraph,
    Table,
)
from flexspline.results.report.picture_blocks import shown_charts
from flexspline.results.report.spans import Words, bold, plain, symbol, worded
from flexspline.results.sentences import sentence


def whole_gear(content: ReportContent, roomy: bool) -> Iterable[Block]:
    """What turns at the output with teeth, rim and bearing in contact."""
    yield Heading("The whole gear", "gear")
    curve = content.gear
    if curve is None:
        why = content.stiffnesses.missing["gear"]
        yield Callout("amber", text=bold("Not computed: ") + plain(f"{why}."))
        return
    K1, K2, K3 = (symbol(quantity(f"K{n}_Nm_per_rad").symbol) for n in (1, 2, 3))
    yield Paragraph(
        plain(
            "A torque acts on the output while the wave generator is locked: tooth pairs come into contact "
            "one after another, the rim may lift off its bearing, and races and balls deform elastically. "
            "Catalogues give such a curve as three slopes: "
        )
        + K1
        + plain(" up to ")
        + _torque(curve, "T1_Nm")
        + plain(", ")
        + K2
        + plain(" up to ")
        + _torque(curve, "T2_Nm")
        + plain(", and ")
        + K3
        + plain(" up to the rated torque ")
        + _torque(curve, "rated_torque_Nm")
        + plain(". Friction is not modelled.")
    )
    yield Table(
        columns=(
            Column("Quantity", grow=1),
            Column("Symbol"),
            Column("Value", "right"),
            Column("Unit"),
        ),
        rows=tuple(
            (entry.name, symbol(entry.symbol), bold(entry.text(value)), entry.unit)
            for entry in quantities_of("gear")
            if (value := getattr(curve, entry.key)) is not None
        ),
        caption=plain("The whole gear. ") + _shares(curve),
    )
    yield from shown_charts(content, roomy, "gear")
    yield _beside(content.backlash, curve)
    yield from _assumed(curve)


def _torque(curve: GearCurve, key: str) -> Words:
    entry = quantity(key)
    return symbol(entry.symbol) + plain(f" = {entry.with_unit(getattr(curve, key))}")


def _shares(curve: GearCurve) -> Words:
    shares = ", ".join(f"{100 * v:.0f} % {part}" for part, v in curve.compliance_shares.items())
    return plain(f"Shares of the compliance at rated torque: {shares}.")


def _beside(total: Backlash, curve: GearCurve) -> Table:
    """The sum's terms and what the gear has in their place."""
    rows = []
    load = "" if curve.terms_torque_Nm is None else f" = {curve.terms_torque_Nm:g} N·m"
    for term, name in term_names().items():
        in_sum = None if term == TIGHT else getattr(total, f"{term}_arcsec")
        in_gear = curve.terms_arcsec[term]
        rows.append(
            (
                name,
                "–" if in_sum is None else grouped(in_sum, 1),
                grouped(in_gear, 1),
                grouped(round(in_gear, 1) - round(in_sum or 0.0, 1), 1),
            )
        )
    return Table(
        columns=(
            Column(worded(f"Twist between ± T_L{load}, arcsec"), grow=1), Column("Sum", "right"),
            Column("Whole gear", "right"), Column("Difference", "right"),
        ),
        rows=tuple(rows),
        caption="Backlash sum and whole gear compared. The whole gear’s flexspline wind-up includes "
        "teeth and bearing. The angle of a clearance is the decrease of the free angle when this clearance "
        "is removed: first the flank clearance, then the bearing play. The gap without any clearance remains "
        "because balls, race and rim deform elastically and the teeth do not reach full depth; the sum has "
        "no such term.",
        strong=len(rows) - 1,
    )  # fmt: skip


def _assumed(curve: GearCurve) -> Iterable[Block]:
    values = "; ".join(f"{a.key} = {plain_number(a.value, 4)} ({a.why})" for a in curve.assumed)
    yield Paragraph(
        bold("Assumed, because the design file does not state it: ") + plain(f"{values}.")
    )
    if curve.warnings:
        yield Callout("amber", items=tuple(map(sentence, gear_warnings(curve))))
    if curve.notes:
        yield Callout("blue", items=tuple(map(sentence, gear_notes(curve))))
