"""Notes on end points: limits of the conclusions, with the numbers."""

from __future__ import annotations

from math import isfinite

from flexspline.geometry.listed import listed
from flexspline.pipeline.diagnosis.end_points.envelope import Envelope
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis, UnitFinding
from flexspline.results.numbers import signed

MOST_LISTED = 12
"""Units that are spelt out in a note; of more, the furthest."""


def end_point_notes(analysis: EndPointAnalysis) -> tuple[str, ...]:
    """Units, limits, the common gap and the mid positions."""
    furthest = sorted(analysis.units, key=lambda u: u.p_value)[:MOST_LISTED]
    notes = [_unit_note(u) for u in furthest]
    for u in furthest:
        if not u.within:
            notes.append(_limit_note(u, analysis.envelope_at(u.torque_Nm)))
    common, std = analysis.common
    if len(analysis.units) > 1:
        notes.append(
            f"common to all units: {signed(common, 1)} ± {std:.1f} arcsec of gap (the stated "
            "uncertainty is its prior); the rest differs from unit to unit"
        )
    mids = analysis.mids
    positions = listed((signed(m, 1) for m in mids.mid_arcsec), "units")
    notes.append(
        f"mid positions {positions} arcsec: the symmetric model predicts 0, but each unit's angle zero is "
        "unknown, so the mid positions cannot confirm or reject this; stiffness that differs with "
        f"direction could move a mid position by at most {mids.asymmetry_reach_arcsec:.1f} arcsec"
        + ("" if analysis.several_torques else ", and only a second torque would show it")
    )
    return tuple(notes)


def _unit_note(u: UnitFinding) -> str:
    where = "within" if u.within else "beyond"
    return (
        f"unit {u.unit} at ± {u.torque_Nm:g} N·m: {u.total_arcsec:.1f} against {u.predicted_arcsec:.1f} ± "
        f"{u.std_arcsec:.1f} arcsec, {signed(u.z, 1)} standard deviations, {where} the stated uncertainty "
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
        return (
            f"unit {u.unit}: the design states no uncertainty of its clearances, so they cannot explain the "
            "deviation"
        )
    if u.z < 0 or not isfinite(of.play_end_arcsec):
        return f"unit {u.unit}: {least}"
    limit = of.limit_arcsec()
    side = "larger" if u.total_arcsec > limit else "smaller"
    return (
        f"unit {u.unit}: {least}; with j_bn0 one standard deviation larger and c = c_max, where the involute "
        f"model saturates, the sum is {limit:.1f} arcsec; the measured total is {side}"
    )
