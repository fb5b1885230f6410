"""Warnings and notes of the whole gear in words, a line each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, assert_never

from flexspline.geometry.errors import plain_number
from flexspline.geometry.rated import LOST_MOTION_TORQUE
from flexspline.pipeline.gear.gear_remarks import (
    BucklingTube,
    CuttingFlanks,
    EarlyEnd,
    FallingStiffness,
    GearNote,
    GearWarning,
    HalvedBalls,
    JointClearances,
    LoadBeyondRated,
    LoadedLastPair,
    LowRatio,
    LowRim,
    PlainGearNote,
    PressingFlanks,
    RelievedFlanks,
    ShapedFaces,
    StraightFlanks,
    TightFlanks,
    TwoTorques,
    WrongStroke,
)
from flexspline.pipeline.gear.largest_torques import two_digits

if TYPE_CHECKING:
    from flexspline.pipeline.gear.gear_curve import GearCurve

ENDS = {"ratchets": "the gear ratchets", "buckles": "the flexspline's tube buckles"}
PLAIN_NOTES: Mapping[PlainGearNote, str] = {
    "play_beside_stroke": "bearing play reduces the free angle here, because the plug's stroke is not "
    "m(z2 - z1)/2: use the terms bearing_play and tight_gear only together",
    "no_ratcheting": "no torque was found at which the gear ratchets",
    "tube_yields_first": "the flexspline's tube is short or thick: it yields before it buckles",
    "tube_buckles_first": "the flexspline's tube buckles before the gear ratchets: the ratcheting torque "
    "lies above the buckling torque",
    "both_limits_alike": "buckling torque and ratcheting torque are computed separately; they are equal only "
    "because both are rounded to two digits",
    "ratcheting_is_upper": "the ratcheting torque is an upper limit, because the model is elastic; gears in "
    "catalogues ratchet at 1/50 (ratio 30) to 1/5 (ratio 160) of this torque",
}


def gear_warnings(curve: GearCurve) -> list[str]:
    """What makes it a gear that was not intended."""
    return [_warning(warning) for warning in curve.warnings]


def gear_notes(curve: GearCurve) -> list[str]:
    """What was simplified."""
    return [_note(note) for note in curve.notes]


def _warning(warning: GearWarning) -> str:
    match warning:
        case PressingFlanks(force):
            return (
                f"teeth press on both flanks without torque, up to {_rounded(force)} N each: "
                f"{_why_pressing(warning)}. The gear then has no free play, and the clearance "
                "terms of the backlash sum do not apply"
            )
        case CuttingFlanks(shape, start, overlap, most, depth):
            text = (
                f"{shape} flanks interfere at {start:.0f}° and more from the major axis, by up to "
                f"{_rounded(overlap)} µm at {most:.0f}°: use the relieved shape or more clearance"
            )
            if depth is None:
                return text
            return f"{text}, or make the working depth less than {depth:.3g} mm"
        case LoadBeyondRated(load, rated):
            return (
                f"load.torque_Nm = {load:g} is {load / rated:.3g} times the "
                "rated torque: teeth and rim do not stay elastic at this torque"
            )
        case EarlyEnd(end, torque, rated):
            text = f"{ENDS[end]} at about {_rounded(torque)} N·m"
            return f"{text}, below the rated torque of {plain_number(rated, 4)} N·m"
        case "play_closes_gap":
            return (
                "more bearing play reduces the free angle here: the play reduces the rim's stroke so far "
                "that teeth beside the major axis touch first. This is not an improvement: reduce the play"
            )
        case _:
            assert_never(warning)


def _why_pressing(pressing: PressingFlanks) -> str:
    match pressing.why:
        case WrongStroke(stroke, full):
            return f"the plug's stroke of {stroke:.3g} mm is not m(z2 - z1)/2 = {full:.3g} mm"
        case LowRim(half_play, stroke):
            return (
                f"half the play, {half_play:.3g} mm, reduces the rim's stroke of {stroke:.3g} mm; teeth off "
                "the major axis then touch"
            )
        case "flanks_cut":
            return "the flanks interfere"
        case TightFlanks(front, back):
            return (
                f"front flanks press at {front:.0f}°, back flanks at {back:.0f}° from the major axis; the "
                "clearance is too small there"
            )
        case _:
            assert_never(pressing.why)


def _note(note: GearNote) -> str:
    if isinstance(note, str):
        return PLAIN_NOTES[note]
    match note:
        case HalvedBalls(count, computed):
            return (
                f"the model has {computed} balls instead of {count}: it needs an even number, one half for "
                "each lobe"
            )
        case LowRatio(limit):
            return (
                f"below a ratio of {limit:g} the model is too stiff: gears of ratio 30 in catalogues are "
                "about half as stiff as the model if its thicknesses are in proportion to the pitch radius "
                "(docs/whole-gear.md)"
            )
        case RelievedFlanks(start, removed, end):
            return (
                f"beyond {start:.0f}° from the major axis the gap of straight flanks would decrease again; "
                f"relieved flanks are assumed, with {_rounded(removed)} µm removed from each flank at "
                f"{end:.0f}°"
            )
        case ShapedFaces(removed):
            return (
                "the rim deforms to a cone; teeth relieved along the face width are assumed, by up to "
                f'{_rounded(removed)} µm at the ends; gear.tooth_face = "straight" selects straight teeth'
            )
        case StraightFlanks(angle):
            return (
                f"gaps are computed for straight flanks of {angle:g}°, not for the "
                'drawn flanks; gear.flanks = "drawn" uses the drawn flanks'
            )
        case LoadedLastPair(at):
            return (
                f"the last pair of teeth within the working depth, {at:.0f}° from "
                "the major axis, carries a large force; this force, K2 and K3 depend on "
                "gear.working_depth_mm; do not size teeth by this force"
            )
        case TwoTorques(load, lost_motion):
            return (
                f"the terms are computed at load.torque_Nm = {load:g}, the lost motion at "
                f"{plain_number(lost_motion, 4)} N·m ({LOST_MOTION_TORQUE}), so the sum of the terms is not "
                "the lost motion"
            )
        case JointClearances(alone, term):
            return (
                "flank clearance and bearing play interact: if only the play is removed, the free angle "
                f"decreases by {_rounded(alone)} arcsec; the terms remove the flank clearance first, so the "
                f"term of the play is {_rounded(term)} arcsec"
            )
        case FallingStiffness(lower, higher, share, preload):
            text = (
                f"{lower} is {100 * share:.2g} % below {higher}: this gear becomes softer at larger torque, "
                "but gears in catalogues become stiffer"
            )
            if not preload:
                return text
            return f"{text}. Here both flanks press without torque, and two flanks are stiffer than one"
        case BucklingTube(torque, stress):
            return (
                f"the flexspline's tube buckles at about {_rounded(torque)} N·m (lower bound of tests), "
                f"where its shear stress is {_rounded(stress)} MPa; a wall with a lower yield stress fails "
                "earlier; gears in catalogues ratchet at 0.3 to 0.8 of their buckling torque"
            )
        case _:
            assert_never(note)


def _rounded(value: float) -> str:
    """Two digits: it is an estimate."""
    return plain_number(two_digits(value))
