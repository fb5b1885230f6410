"""Derivatives of the backlash sum with respect to each clearance."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians, sin

from flexspline.geometry.design import Design
from flexspline.geometry.fields import MM_PER_UM
from flexspline.pipeline.backlash import ARCSEC_PER_RAD, clearance_angle, play_clearance
from flexspline.pipeline.bearing_play import involute_clearance_slope


@dataclass(frozen=True)
class ClearanceSlope:
    """One clearance's part of the sum.

    Attributes
    ----------
    key : of the design file.
    arcsec : its term of the sum.
    arcsec_per_um : what one µm more adds to the sum.
    """

    key: str
    value_um: float
    arcsec: float
    arcsec_per_um: float


def clearance_slopes(design: Design) -> tuple[ClearanceSlope, ClearanceSlope]:
    """Return the slopes of flank clearance and bearing play from the sum's own terms, without a stiffness.

    Examples
    --------
    The XB1-40's 3 µm between flanks are 32.9 arcsec, in proportion (article, table 3):

    >>> from flexspline import load_design
    >>> flank, play = clearance_slopes(load_design("examples/xb1-40.toml"))
    >>> round(flank.arcsec, 1), round(flank.arcsec_per_um, 2)
    (32.9, 10.98)
    """
    gear, bearing = design.gear, design.bearing
    alpha, play_um = radians(gear.pressure_angle_deg), bearing.radial_clearance_um
    if bearing.bearing_play_model == "small_displacement":
        share = sin(alpha)
    else:
        share = involute_clearance_slope(play_um * MM_PER_UM, gear.centre_distance_mm, alpha)
    per_um = clearance_angle(design, MM_PER_UM) * ARCSEC_PER_RAD
    flank_um = gear.flank_clearance_um
    play = clearance_angle(design, play_clearance(design)) * ARCSEC_PER_RAD
    return (
        ClearanceSlope("gear.flank_clearance_um", flank_um, flank_um * per_um, per_um),
        ClearanceSlope("bearing.radial_clearance_um", play_um, play, share * per_um),
    )
