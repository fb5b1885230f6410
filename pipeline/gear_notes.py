"""What a reader of the whole gear's figures must know: what was simplified, and what is no gear that runs."""

from __future__ import annotations

from math import degrees

import numpy as np

from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.fea.gear.kinematics import STEPS, Mesh
from flexspline.fea.gear.model import GearModel
from flexspline.geometry.design import Design
from flexspline.geometry.rated import rated_torque
from flexspline.geometry.wave_generator import flexible_bearing
from flexspline.pipeline.gear_model import even

LOW_RIM = 0.05
"""Of the stroke: a rim that stands off by more takes clearance from teeth off the major axis."""
RATCHETING = (
    "the ratcheting torque is an estimate from above: loss of engagement where nothing but elastic parts "
    "yields; catalogues' gears ratchet at a fiftieth (ratio 30) to a fifth (ratio 160) of it"
)
"""Shares: docs/whole-gear.md."""
LEAST_OVERLAP = 1e-6
"""mm: rounding."""
BEYOND_RATED = 5.0
"""Times rated torque: more than any catalogue's peak torque, 2 to 4.5 times (HD, CSF)."""


def both_press_N(model: GearModel, unloaded: Equilibrium) -> float:
    """Largest force of a pair of teeth where both flanks press without torque [N]; 0 where one is free."""
    front, back = np.split(unloaded.loaded[model.flanks], 2)
    if not (front.any() and back.any()):
        return 0.0
    return float(unloaded.forces[model.flanks].max()) / model.teeth_per_station


def warnings(design: Design, model: GearModel, preload_N: float) -> list[str]:
    """What makes the gear another one than was meant."""
    lines = []
    if preload_N:
        lines.append(
            f"teeth press on both flanks without torque, up to {_rounded(preload_N)} N each: "
            f"{_why_both_press(design, model)}"
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
    phi = np.linspace(0, mesh.reach, STEPS)
    front = mesh.free_gaps(phi, mesh.stroke)[0] + mesh.relief(phi)[0]
    if front.min() >= -LEAST_OVERLAP:
        return None
    clear = phi[np.flatnonzero(front < 0)[0]]
    return (
        f"{mesh.flanks} flanks cut into each other beyond {degrees(clear):.0f}° from the major axis, by up "
        f"to {_rounded(-1e3 * front.min())} µm: relieve them, or make the working depth less than "
        f"{mesh.stroke * (1 - np.cos(2 * clear)):.3g} mm"
    )


def _why_both_press(design: Design, model: GearModel) -> str:
    stroke, full = model.wave_generator.deflection, design.gear.centre_distance_mm
    play = design.bearing.radial_clearance_um / 2e3
    if abs(stroke / full - 1) > LOW_RIM:
        return f"the plug's stroke of {stroke:.3g} mm is not m(z2 - z1)/2 = {full:.3g} mm"
    if play > LOW_RIM * stroke:
        return (
            f"half the play, {play:.3g} mm, lowers the rim's stroke of {stroke:.3g} mm, and teeth off the "
            "major axis no longer clear"
        )
    if _cuts_in(model.mesh):
        return "the flanks cut into each other"
    return "the flank clearance is too small"


def notes(design: Design, model: GearModel, teeth: np.ndarray) -> list[str]:
    """What was simplified; `teeth` (t,) [N]: forces at rated torque."""
    lines = []
    balls = flexible_bearing(design).ball_count
    if even(balls) != balls:
        lines.append(f"{balls} balls are computed as {even(balls)}: both lobes have the same")
    mesh = model.mesh
    if mesh.flanks == "relieved" and mesh.largest_relief > 0:
        lines.append(
            f"plain flanks come closer again beyond {degrees(mesh.relieved_from):.0f}° from the major axis: "
            f"taken as relieved, by {_rounded(1e3 * mesh.largest_relief)} µm at {degrees(mesh.reach):.0f}°"
        )
    if mesh.face == "relieved":
        outwards, along = model.rim.cone(mesh.stroke)
        off = np.abs(mesh.closing(model.tooth_angles[:, None], outwards, along)).max()
        lines.append(
            "the rim opens as a cone: teeth are taken as relieved for it along their face, by up to "
            f'{_rounded(1e3 * off)} µm at its ends; gear.tooth_face = "straight" leaves that out'
        )
    if design.flexspline.teeth == "drawn" and mesh.flanks != "drawn":
        lines.append(
            f"gaps are those of straight flanks of {design.gear.pressure_angle_deg:g}°, not of the drawn "
            'ones; gear.flanks = "drawn" takes those'
        )
    most = int(np.abs(teeth).argmax())
    if most in (0, len(teeth) - 1):
        lines.append(
            f"the pair of teeth that carries most stands {abs(degrees(model.tooth_angles[most])):.0f}° from "
            "the major axis, at the end of the working depth that is assumed: its force hangs on that end"
        )
    return lines


def _rounded(value: float) -> str:
    return f"{float(f'{value:.2g}'):g}"
