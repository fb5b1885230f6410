"""Notes and warnings on the whole gear: simplifications, and gears that do not run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import degrees

import numpy as np

from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.fea.gear.kinematics import GAP_STEPS, ToothMesh
from flexspline.fea.gear.model import GearModel
from flexspline.geometry.circular_spline import SHALLOWEST
from flexspline.geometry.design import Design
from flexspline.geometry.rated import rated_torque
from flexspline.geometry.wave_generator import flexible_bearing
from flexspline.pipeline.gear.gear_model import even
from flexspline.pipeline.gear.gear_remarks import (
    CuttingFlanks,
    FallingStiffness,
    GearNote,
    GearWarning,
    HalvedBalls,
    JointClearances,
    LoadBeyondRated,
    LoadedLastPair,
    LowRatio,
    LowRim,
    PressingFlanks,
    RelievedFlanks,
    ShapedFaces,
    StraightFlanks,
    TightFlanks,
    TwoTorques,
    WrongStroke,
)
from flexspline.pipeline.gear.gear_terms import PlayEffect

LOW_RIM = 0.05
"""Share of the stroke. If the rim stands off by more, the clearance of teeth off the major axis decreases."""
AT_THE_END = 0.5
"""Share of the largest tooth force. If the last pair within the working depth carries more, a note says
so."""
LEAST_RELIEF = 1e-3
"""[mm] A smaller relief is no change of the flank's shape."""
LEAST_OVERLAP = 1e-6
"""[mm] A smaller overlap is rounding."""
LOW_RATIO = 45
"""Ratio below which a note says that the model is too stiff: catalogues agree with the model at 50, but not
at 30."""
BEYOND_RATED = 5.0
"""Load torque over rated torque, above which a warning is given. Peak torques in catalogues are 2 to 4.5
times the rated torque (HD, CSF)."""


LEAST_ANGLE = 0.1
"""[arcsec] A smaller angle is rounding of the equilibrium."""
SAME_TORQUE = 0.01
"""Relative difference of two torques that is rounding of the design file: `init` writes three digits."""
LEAST_FALL = 0.02
"""Smallest fall of the stiffness that is reported: the number of places along a tooth changes K1 by up to 2 %
(`gear_model`)."""
ACT_TOGETHER = 0.2
"""Share of the play's own effect. If the order of removal changes the effect by less, no note is given."""


def both_press_N(model: GearModel, unloaded: Equilibrium) -> float:
    """Return the largest force of a pair that presses on both flanks without torque [N], or 0."""
    front, back = np.split(unloaded.loaded[model.flanks], 2)
    if not (front.any() and back.any()):
        return 0.0
    return float(model.flank_forces(unloaded).max())


def warnings(design: Design, model: GearModel, unloaded: Equilibrium) -> list[GearWarning]:
    """Return why this is a gear that was not intended."""
    listed: list[GearWarning] = []
    if preload_N := both_press_N(model, unloaded):
        listed.append(_pressing(preload_N, design, model, unloaded))
    if cuts := _cuts_in(model.mesh):
        listed.append(cuts)
    rated, _ = rated_torque(design)
    if design.load.torque_Nm > BEYOND_RATED * rated:
        listed.append(LoadBeyondRated(design.load.torque_Nm, rated))
    return listed


def _cuts_in(mesh: ToothMesh) -> CuttingFlanks | None:
    """Where flanks that are not relieved overlap within the working depth."""
    phi = np.linspace(0, mesh.reach, GAP_STEPS)
    front = mesh.free_gaps(phi, mesh.stroke)[0] + mesh.relief(phi)[0]
    if front.min() >= -LEAST_OVERLAP:
        return None
    clear = phi[np.flatnonzero(front < 0)[0]]
    depth = float(mesh.stroke * (1 - np.cos(2 * clear)))
    return CuttingFlanks(
        mesh.flanks,
        degrees(clear),
        float(-1e3 * front.min()),
        degrees(phi[front.argmin()]),
        depth if depth > SHALLOWEST * mesh.stroke else None,
    )


def _pressing(
    preload_N: float, design: Design, model: GearModel, unloaded: Equilibrium
) -> PressingFlanks:
    stroke, full = model.wave_generator.deflection, design.gear.centre_distance_mm
    play = design.bearing.radial_clearance_mm / 2
    if abs(stroke / full - 1) > LOW_RIM:
        return PressingFlanks(preload_N, WrongStroke(stroke, full))
    if play > LOW_RIM * stroke:
        return PressingFlanks(preload_N, LowRim(play, stroke))
    if _cuts_in(model.mesh):
        return PressingFlanks(preload_N, "flanks_cut")
    front, back = model.flank_forces(unloaded)
    ahead, behind = (degrees(model.tooth_angles[forces.argmax()]) for forces in (front, back))
    return PressingFlanks(preload_N, TightFlanks(ahead, behind))


def notes(design: Design, model: GearModel, teeth: np.ndarray) -> list[GearNote]:
    """Return the simplifications; `teeth` (t,) [N]: forces at rated torque."""
    listed: list[GearNote] = []
    balls = flexible_bearing(design).ball_count
    if even(balls) != balls:
        listed.append(HalvedBalls(balls, even(balls)))
    if design.gear.ratio < LOW_RATIO:
        listed.append(LowRatio(LOW_RATIO))
    mesh = model.mesh
    if mesh.flanks == "relieved" and mesh.largest_relief > LEAST_RELIEF:
        removed_um = 1e3 * mesh.largest_relief
        listed.append(RelievedFlanks(degrees(mesh.relieved_from), removed_um, degrees(mesh.reach)))
    if mesh.face == "relieved":
        outwards, along = model.rim.cone(mesh.stroke)
        off = np.abs(mesh.closing(model.tooth_angles[:, None], outwards, along)).max()
        listed.append(ShapedFaces(float(1e3 * off)))
    if design.flexspline.teeth == "drawn" and mesh.flanks != "drawn":
        listed.append(StraightFlanks(design.gear.pressure_angle_deg))
    size = np.abs(teeth)
    if max(size[0], size[-1]) > AT_THE_END * size.max():
        listed.append(LoadedLastPair(degrees(model.tooth_angles[-1])))
    return listed


def of_chords(chords: Sequence[float], preload_N: float) -> list[GearNote]:
    """Return a note for K2 below K1 and for K3 below K2 [N·m/rad]: a catalogue's gear grows stiffer."""
    names = [f"K{place}" for place in range(1, len(chords) + 1)]
    return [
        FallingStiffness(lower, higher, 1 - K / before, preload_N)
        for (higher, before), (lower, K) in pairwise(zip(names, chords, strict=True))
        if (1 - LEAST_FALL) * before > K
    ]


def of_torques(load_Nm: float, lost_motion_Nm: float) -> list[GearNote]:
    """Return a note where terms and lost motion are not of one torque."""
    if abs(load_Nm / lost_motion_Nm - 1) <= SAME_TORQUE:
        return []
    return [TwoTorques(load_Nm, lost_motion_Nm)]


def of_play(
    terms_arcsec: Mapping[str, float], play: PlayEffect, full_stroke: bool
) -> tuple[list[GearWarning], list[GearNote]]:
    """Return warnings and notes where the bearing's play does not simply open the mesh.

    `full_stroke`: the plug's stroke is m(z2 - z1)/2.
    """
    warned: list[GearWarning] = ["play_closes_gap"] if play.last_tenth < -LEAST_ANGLE else []
    noted: list[GearNote] = []
    term = terms_arcsec["bearing_play"]
    if term < -LEAST_ANGLE and not full_stroke:
        noted.append("play_beside_stroke")
    elif term >= -LEAST_ANGLE and abs(play.whole - term) > max(
        LEAST_ANGLE, ACT_TOGETHER * abs(play.whole)
    ):
        noted.append(JointClearances(play.whole, term))
    return warned, noted
