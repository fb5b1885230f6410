"""What a reader of the whole gear's figures must know: what was simplified, and what is no gear that runs."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees

import numpy as np

from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.fea.gear.kinematics import GAP_STEPS, Mesh
from flexspline.fea.gear.model import GearModel
from flexspline.geometry.circular_spline import SHALLOWEST
from flexspline.geometry.design import Design
from flexspline.geometry.rated import LOST_MOTION_TORQUE, rated_torque
from flexspline.geometry.wave_generator import flexible_bearing
from flexspline.pipeline.gear_model import even
from flexspline.pipeline.gear_terms import PlayEffect
from flexspline.pipeline.largest_torques import rounded

LOW_RIM = 0.05
"""Of the stroke: a rim that stands off by more takes clearance from teeth off the major axis."""
AT_THE_END = 0.5
"""Of the largest tooth force: a pair at the end of the working depth that carries more decides much."""
LEAST_RELIEF = 1e-3
"""mm: what is less is no change of a flank's shape."""
LEAST_OVERLAP = 1e-6
"""mm: rounding."""
LOW_RATIO = 45
"""Below 50, where catalogues and the model agree, and above 30, where they do not."""
BEYOND_RATED = 5.0
"""Times rated torque: more than any catalogue's peak torque, 2 to 4.5 times (HD, CSF)."""


LEAST_ANGLE = 0.1
"""arcsec: what is less is rounding of the equilibrium."""
SAME_TORQUE = 0.01
"""A difference of less is rounding of a design file: `init` writes three digits."""
ACT_TOGETHER = 0.2
"""Of the play's own effect: a smaller difference of the two orders is not worth a note."""


def both_press_N(model: GearModel, unloaded: Equilibrium) -> float:
    """Largest force of a pair of teeth where both flanks press without torque [N]; 0 where one is free."""
    front, back = np.split(unloaded.loaded[model.flanks], 2)
    if not (front.any() and back.any()):
        return 0.0
    return float(model.flank_forces(unloaded).max())


def warnings(design: Design, model: GearModel, unloaded: Equilibrium) -> list[str]:
    """What makes the gear another one than was meant."""
    lines = []
    preload_N = both_press_N(model, unloaded)
    if preload_N:
        lines.append(
            f"teeth press on both flanks without torque, up to {rounded(preload_N)} N each: "
            f"{_why_both_press(design, model, unloaded)}"
        )
    if cuts := _cuts_in(model.mesh):
        lines.append(cuts)
    rated, _ = rated_torque(design)
    if design.load.torque_Nm > BEYOND_RATED * rated:
        lines.append(
            f"load.torque_Nm = {design.load.torque_Nm:g} is {design.load.torque_Nm / rated:.3g} times the "
            "rated torque: teeth and rim are not elastic there"
        )
    return lines


def _cuts_in(mesh: Mesh) -> str | None:
    """Where flanks that are not relieved overlap within the working depth."""
    phi = np.linspace(0, mesh.reach, GAP_STEPS)
    front = mesh.free_gaps(phi, mesh.stroke)[0] + mesh.relief(phi)[0]
    if front.min() >= -LEAST_OVERLAP:
        return None
    clear = phi[np.flatnonzero(front < 0)[0]]
    least = degrees(phi[front.argmin()])
    depth = mesh.stroke * (1 - np.cos(2 * clear))
    shallow = f", or make the working depth less than {depth:.3g} mm"
    return (
        f"{mesh.flanks} flanks cut into each other from {degrees(clear):.0f}° off the major axis on, by up "
        f"to {rounded(-1e3 * front.min())} µm at {least:.0f}°: take the relieved shape or more clearance"
        + (shallow if depth > SHALLOWEST * mesh.stroke else "")
    )


def _why_both_press(design: Design, model: GearModel, unloaded: Equilibrium) -> str:
    stroke, full = model.wave_generator.deflection, design.gear.centre_distance_mm
    play = design.bearing.radial_clearance_mm / 2
    if abs(stroke / full - 1) > LOW_RIM:
        return f"the plug's stroke of {stroke:.3g} mm is not m(z2 - z1)/2 = {full:.3g} mm"
    if play > LOW_RIM * stroke:
        return (
            f"half the play, {play:.3g} mm, lowers the rim's stroke of {stroke:.3g} mm, and teeth off the "
            "major axis no longer clear"
        )
    if _cuts_in(model.mesh):
        return "the flanks cut into each other"
    front, back = model.flank_forces(unloaded)
    ahead, behind = (degrees(model.tooth_angles[each.argmax()]) for each in (front, back))
    return (
        f"front flanks press at {ahead:.0f}°, back flanks at {behind:.0f}° from the major axis; the "
        "clearance is too small there"
    )


def notes(design: Design, model: GearModel, teeth: np.ndarray) -> list[str]:
    """What was simplified; `teeth` (t,) [N]: forces at rated torque."""
    lines = []
    balls = flexible_bearing(design).ball_count
    if even(balls) != balls:
        lines.append(f"{balls} balls are computed as {even(balls)}, half of them in each lobe")
    if design.gear.ratio < LOW_RATIO:
        lines.append(
            f"below a ratio of {LOW_RATIO} the model is too stiff: with thicknesses in proportion to the "
            "pitch radius catalogues' gears of ratio 30 are about half as stiff (docs/whole-gear.md)"
        )
    mesh = model.mesh
    if mesh.flanks == "relieved" and mesh.largest_relief > LEAST_RELIEF:
        lines.append(
            f"straight flanks come closer again beyond {degrees(mesh.relieved_from):.0f}° from the major "
            f"axis: relieved flanks are assumed, {rounded(1e3 * mesh.largest_relief)} µm of each removed at "
            f"{degrees(mesh.reach):.0f}°"
        )
    if mesh.face == "relieved":
        outwards, along = model.rim.cone(mesh.stroke)
        off = np.abs(mesh.closing(model.tooth_angles[:, None], outwards, along)).max()
        lines.append(
            "the rim opens as a cone: teeth that are shaped for it along their face are assumed, up to "
            f'{rounded(1e3 * off)} µm at its ends; gear.tooth_face = "straight" computes straight teeth'
        )
    if design.flexspline.teeth == "drawn" and mesh.flanks != "drawn":
        lines.append(
            f"gaps are those of straight flanks of {design.gear.pressure_angle_deg:g}°, not of the drawn "
            'ones; gear.flanks = "drawn" takes those'
        )
    size = np.abs(teeth)
    if max(size[0], size[-1]) > AT_THE_END * size.max():
        lines.append(
            f"the last pair of teeth within the working depth, {degrees(model.tooth_angles[-1]):.0f}° from "
            "the major axis, carries much: the figures depend on gear.working_depth_mm"
        )
    return lines


def of_torques(load_Nm: float, lost_motion_Nm: float) -> tuple[list[str], list[str]]:
    """No warning, and a note where terms and lost motion are not of one torque."""
    if abs(load_Nm / lost_motion_Nm - 1) <= SAME_TORQUE:
        return [], []
    return [], [
        f"the terms are at load.torque_Nm = {load_Nm:g}, the lost motion at {lost_motion_Nm:.4g} N·m, "
        f"{LOST_MOTION_TORQUE}: the terms' sum is not the lost motion"
    ]


def of_play(
    terms_arcsec: Mapping[str, float], play: PlayEffect, full_stroke: bool
) -> tuple[list[str], list[str]]:
    """Warnings and notes where the bearing's play does not simply open the mesh.

    `full_stroke`: the plug's stroke is m(z2 - z1)/2.
    """
    warned, noted = [], []
    if play.last_tenth < -LEAST_ANGLE:
        warned.append(
            "more bearing play makes the free angle smaller here: it lowers the rim's stroke so far that "
            "teeth beside the major axis touch first. The gear is no better for it: reduce the play"
        )
    term = terms_arcsec["bearing_play"]
    if term < -LEAST_ANGLE and not full_stroke:
        noted.append(
            "bearing play makes the free angle smaller here, as the plug's stroke is not m(z2 - z1)/2: read "
            "bearing_play and tight_gear together"
        )
    elif term >= -LEAST_ANGLE and abs(play.whole - term) > max(
        LEAST_ANGLE, ACT_TOGETHER * abs(play.whole)
    ):
        noted.append(
            f"flank clearance and bearing play act together: without play alone the free angle is "
            f"{rounded(play.whole)} arcsec smaller; the terms take the flank clearance away first, and "
            f"leave {rounded(term)} arcsec to the play"
        )
    return warned, noted
