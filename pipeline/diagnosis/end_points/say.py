"""A verdict on end points in plain words."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.end_points.envelope import Envelope
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis, UnitFinding
from flexspline.pipeline.diagnosis.outcome import NamedCause, Verdict, left_out

LISTED = 12
"""Units that are spelt out in a note; of more, the furthest."""


def summary_of(
    verdict: Verdict, found: Sequence[NamedCause], analysis: EndPointAnalysis, several: bool
) -> str:
    """One or two sentences."""
    beyond = [u for u in analysis.units if not u.within]
    who = _units(beyond)
    title = known_causes()[found[0].id].title if found else ""
    match verdict:
        case "consistent":
            return "Every unit's total agrees with the simulation within its stated uncertainty."
        case "named":
            return left_out(found, _said)
        case "unknown":
            return "The totals depend on torque in a way that no known cause explains."
        case _:
            others = ", ".join(known_causes()[a].title for a in found[0].alternatives)
            rival = (
                f"{title} cannot be told from {others}"
                if others
                else f"{title} is only a suspicion"
            )
            where = (
                f"{who} beyond the predicted envelope"
                if beyond
                else "The totals differ from the prediction"
            )
            why = "" if several else ", because each unit was measured at one torque"
            return f"{where}, and these end points cannot tell why: {rival}{why}."


def _said(c: NamedCause) -> str:
    return f"{c.title}, {c.magnitude:.3g} ± {c.magnitude_std:.2g} {c.unit}".removesuffix(" 1")


def notes_of(analysis: EndPointAnalysis, several: bool) -> tuple[str, ...]:
    """What else can and cannot be concluded, with the numbers."""
    furthest = sorted(analysis.units, key=lambda u: u.p_value)[:LISTED]
    notes = [_unit_note(u) for u in furthest]
    for u in furthest:
        if not u.within:
            notes.append(_limit_note(u, analysis.envelope_at(u.torque_Nm)))
    common, std = analysis.common
    if len(analysis.units) > 1:
        notes.append(
            f"common to all units: {common:+.1f} ± {std:.1f} arcsec of gap, within the stated uncertainty by "
            "its prior; the rest is each unit's own"
        )
    mids = analysis.mids
    told = ", ".join(f"{m:+.1f}" for m in mids.mid_arcsec[:LISTED])
    notes.append(
        f"mid positions {told} arcsec: the symmetric model predicts 0, but where an angle reading has its "
        "zero is free for each unit, so they neither support nor refute it; stiffness that differs with "
        f"direction could move one by at most {mids.asymmetry_reach_arcsec:.1f} arcsec"
        + ("" if several else ", and only a second torque would show it")
    )
    return tuple(notes)


def _unit_note(u: UnitFinding) -> str:
    where = "within" if u.within else "beyond"
    return (
        f"unit {u.unit} at ±{u.torque_Nm:g} N·m: {u.total_arcsec:.1f} against {u.predicted_arcsec:.1f} ± "
        f"{u.std_arcsec:.1f} arcsec, {u.z:+.1f} standard deviations, {where} the stated uncertainty "
        f"(p = {u.p_value:.2g}, {u.p_corrected:.2g} for all units)"
    )


def _limit_note(u: UnitFinding, of: Envelope) -> str:
    e = u.explanation
    least = (
        f"clearance alone would need about j_bn0 = {e.flank_clearance_um:.1f} µm and c = "
        f"{e.radial_clearance_um:.1f} µm, {e.distance:.1f} standard deviations from the design"
    )
    doubt = of.design.uncertainty
    if not (doubt.flank_clearance_um or doubt.radial_clearance_um):
        return f"unit {u.unit}: the design states no uncertainty of its clearances, so none may explain it"
    if u.z < 0 or not isfinite(of.play_end_arcsec):
        return f"unit {u.unit}: {least}"
    limit = of.limit_arcsec()
    side = "more" if u.total_arcsec > limit else "less"
    return (
        f"unit {u.unit}: {least}; with j_bn0 one standard deviation up and c at c_max, where the involute "
        f"model saturates, the sum is {limit:.1f} arcsec: the unit shows {side}"
    )


def _units(units: Sequence[UnitFinding]) -> str:
    named = ", ".join(u.unit for u in units[:LISTED])
    return f"Unit {named} lies" if len(units) == 1 else f"Units {named} lie"
