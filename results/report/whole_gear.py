"""The report's section on the whole gear: its curve, its shares, and the backlash sum beside it."""

from __future__ import annotations

from collections.abc import Iterable

from flexspline.pipeline.backlash import Backlash
from flexspline.pipeline.gear import GearCurve
from flexspline.pipeline.gear_terms import TIGHT
from flexspline.results.file_names import CURVE, LOADS
from flexspline.results.gear_terms import term_names
from flexspline.results.numbers import grouped
from flexspline.results.quantities import quantity
from flexspline.results.report.content import ReportContent
from flexspline.results.report.document import (
    Block,
    Callout,
    Column,
    Heading,
    Paragraph,
    Picture,
    Table,
)
from flexspline.results.report.shown import shown
from flexspline.results.report.spans import Words, bold, plain, symbol, worded

FIGURES = (
    "K1_Nm_per_rad", "K2_Nm_per_rad", "K3_Nm_per_rad", "lost_motion_arcsec", "lost_motion_torque_Nm",
    "free_angle_arcsec", "teeth_in_contact", "buckling_torque_Nm", "ratcheting_torque_Nm",
)  # fmt: skip
"""By their keys in result.json, in the order of the table."""


def whole_gear(content: ReportContent, roomy: bool) -> Iterable[Block]:
    """What turns at the output with teeth, rim and bearing in contact."""
    yield Heading("The whole gear", "gear")
    curve = content.gear
    if curve is None:
        yield Callout("amber", text=bold("Not found: ") + plain(f"{content.gear_missing}."))
        return
    yield Paragraph(
        plain(
            "The output under torque while the wave generator is locked: tooth pairs come into contact one "
            "after another, the rim may lift off its bearing, races and balls yield. Makers’ catalogues give "
            "such a curve as three slopes, "
        )
        + symbol("K_1")
        + plain(" up to ")
        + symbol("T_1")
        + plain(f" = {curve.T1_Nm:.3g} N·m, ")
        + symbol("K_2")
        + plain(" up to ")
        + symbol("T_2")
        + plain(f" = {curve.T2_Nm:.3g} N·m, and ")
        + symbol("K_3")
        + plain(" up to the rated torque ")
        + symbol("T_N")
        + plain(f" = {curve.rated_torque_Nm:.3g} N·m. Friction is not modelled.")
    )
    yield Table(
        columns=(
            Column("Quantity", grow=1),
            Column("Symbol"),
            Column("Value", "right"),
            Column("Unit"),
        ),
        rows=tuple(_figure(curve, key) for key in FIGURES if getattr(curve, key) is not None),
        caption=plain("The whole gear. ") + _shares(curve),
    )
    slopes = "Angle of the output over torque, and the torques between which the slopes are taken."
    loads = "What tooth pairs and balls carry at rated torque, around one lobe."
    yield from shown(content, roomy, Picture(CURVE, slopes, 66))
    yield from shown(content, roomy, Picture(LOADS, loads, 66))
    yield _beside(content.backlash, curve)
    yield from _assumed(curve)


def _figure(curve: GearCurve, key: str) -> tuple[str | Words, ...]:
    entry = quantity(key)
    return entry.name, symbol(entry.symbol), bold(entry.text(getattr(curve, key))), entry.unit


def _shares(curve: GearCurve) -> Words:
    each = ", ".join(f"{100 * v:.0f} % {part}" for part, v in curve.compliance_shares.items())
    return plain(f"Of its compliance at rated torque: {each}.")


def _beside(total: Backlash, curve: GearCurve) -> Table:
    """The sum's terms and what the gear has in their place."""
    rows = []
    load = "" if curve.terms_torque_Nm is None else f" = {curve.terms_torque_Nm:g} N·m"
    for term, name in term_names().items():
        in_sum = None if term == TIGHT else getattr(total, f"{term}_arcsec")
        own = curve.terms_arcsec[term]
        rows.append(
            (
                name,
                "–" if in_sum is None else grouped(in_sum, 1),
                grouped(own, 1),
                grouped(round(own, 1) - round(in_sum or 0.0, 1), 1),
            )
        )
    return Table(
        columns=(
            Column(worded(f"Twist between ± T_L{load}, arcsec"), grow=1), Column("Sum", "right"),
            Column("Whole gear", "right"), Column("Difference", "right"),
        ),
        rows=tuple(rows),
        caption="The backlash sum beside the whole gear. The whole gear’s flexspline wind-up includes "
        "teeth and bearing; the angle of a clearance is by how much the free angle is smaller without that "
        "clearance. The gap without any clearance: balls, race and rim yield, so that the teeth do not "
        "reach full depth; the sum has no such term.",
        strong=len(rows) - 1,
    )  # fmt: skip


def _assumed(curve: GearCurve) -> Iterable[Block]:
    each = "; ".join(f"{a.key} = {a.value:.4g} ({a.why})" for a in curve.assumed)
    yield Paragraph(bold("Assumed, as the design file does not state it: ") + plain(f"{each}."))
    if curve.warnings:
        yield Callout("amber", items=_sentences(curve.warnings))
    if curve.notes:
        yield Callout("blue", items=_sentences(curve.notes))


def _sentences(lines: Iterable[str]) -> tuple[str, ...]:
    return tuple(f"{line[:1].upper()}{line[1:]}." for line in lines)
