"""Contents of each total in a report, so that totals are not confused."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flexspline.results.quantities import quantity
from flexspline.results.report.content import ReportContent
from flexspline.results.report.spans import Words, bold, plain, ref, symbol, worded

if TYPE_CHECKING:
    from flexspline.pipeline.gear.gear_curve import GearCurve

_SERIES = quantity("K_series_Nm_per_rad")
_SUM = quantity("backlash_arcsec.total")
_FIRST = quantity("K1_Nm_per_rad")


def totals_and_terms(content: ReportContent) -> Words:
    """The series stiffness, the backlash sum and, where it was found, K1 of the whole gear."""
    K = content.stiffnesses.series_Nm_per_rad(content.design)
    text = (
        bold("Totals and terms. ")
        + symbol(_SERIES.symbol)
        + plain(f" = {_SERIES.with_unit(K)} includes only flexspline and shaft (1/")
        + symbol(_SERIES.symbol)
        + worded(f" = 1/{content.sum_symbol} + 1/K_e); the backlash of ")
        + plain(
            f"{_SUM.with_unit(content.backlash.total_arcsec)} is their wind-up plus both clearances ("
        )
        + ref("budget")
        + plain("). ")
    )
    curve = content.gear
    if curve is None:
        return text + plain("Neither includes bolts, housing or friction.")
    return (
        text
        + symbol(_FIRST.symbol)
        + plain(f" = {_FIRST.with_unit(curve.K1_Nm_per_rad)} is that of the whole gear (")
        + ref("gear")
        + plain("): with teeth, rim contact and bearing, but without clearance, as in catalogues. ")
        + _with_clearances(curve)
        + plain(
            (", but no free angle remains here" if curve.free_angle_arcsec == 0 else "")
            + ". Bolts, housing and friction are not included."
        )
    )


def _with_clearances(curve: GearCurve) -> Words:
    """What has the clearances in it: lost motion, and where its terms were asked for the twist between the
    torques of the sum."""
    if not curve.terms_arcsec:
        return plain("Lost motion includes clearances")
    total = _SUM.with_unit(curve.terms_arcsec["total"])
    return worded(
        f"The gear's twist between ± T_L, {total}, and its lost motion include clearances"
    )
