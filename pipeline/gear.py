"""The whole gear with its wave generator locked: θ(T), and what the makers' catalogues say of such a curve.

K1 is the chord from 0 to T1, K2 from T1 to T2, K3 from T2 to rated torque, as in the makers'
catalogues; "0" is a thousandth of rated torque: a clearance that the teeth first cross is not
booked as softness. Lost motion is the whole twist between ± 4 % of rated torque, clearance
included. Friction is left out, so loading and unloading are one curve; and both lobes are alike and teeth
and balls stand alike on both sides of them, so the curve is odd. Positive torques are computed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import degrees

import numpy as np

from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.fea.gear.kinematics import LARGEST_WITHDRAWAL
from flexspline.fea.gear.model import GearModel
from flexspline.fea.threads import one_thread
from flexspline.geometry.design import Design
from flexspline.geometry.rated import rated_torque
from flexspline.geometry.wave_generator import Assumed, flexible_bearing
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.gear_chain import Chain, chain_of, chords
from flexspline.pipeline.gear_model import CONFORMITY, even
from flexspline.pipeline.gear_terms import gear_terms
from flexspline.pipeline.part_stiffness import part_stiffness
from flexspline.pipeline.parts import AnalysisContext

T1_SHARE, T2_SHARE = 0.15, 0.50
"""Of rated torque: the makers' T1 and T2 are 0.13 to 0.20 and 0.39 to 0.69 of it in those four sizes."""
LOST_MOTION_SHARE = 0.04
"""Of rated torque, each way (GB/T 35089-2018; Hrcek et al., Materials 14 (2021) 5057)."""
LOADING = (0.001, LOST_MOTION_SHARE, 0.09, T1_SHARE, 0.25, 0.37, T2_SHARE, 0.66, 0.83, 1.0)
"""Torques that are computed, of rated torque; a chord "from 0" begins at the first."""
LAWS = (
    Assumed("T1 over rated torque", T1_SHARE, "makers': 0.13 to 0.20"),
    Assumed("T2 over rated torque", T2_SHARE, "makers': 0.39 to 0.69"),
    Assumed("groove radius over ball diameter", CONFORMITY, "usual in deep groove bearings"),
    Assumed("working depth over m(z2 - z1)/2", LARGEST_WITHDRAWAL, "teeth of full height"),
)
"""What no key of the design file states."""
LOW_RIM = 0.05
"""Of the stroke: a rim that stands off by more takes clearance from teeth off the major axis."""
BEYOND_RATED = 5.0
"""Times rated torque: more than any catalogue's peak torque, 2 to 4.5 times (HD, CSF)."""
CARRIES = 1e-3
"""Of the largest force: a tooth below it is not counted as in contact."""


@dataclass(frozen=True)
class GearCurve:
    """What the gear's output does under torque.

    Attributes
    ----------
    torque_Nm, angle_arcsec : the loop 0 → rated → −rated → 0, but for 0 itself, where a gear with clearance
        has no angle of its own.
    compliance_shares : of flexspline, shaft, teeth and bearing in dθ/dT at rated torque; they add up to 1.
    assumed : each value that the design file does not state.
    warnings : one line each; `notes` : what was simplified.
    preload_tooth_force_N : largest force of a pair of teeth without torque, where both flanks press; else 0.
    tooth_angle_deg, tooth_force_N : teeth within reach of one lobe at rated torque, front less back flank.
    ball_angle_deg, ball_force_N : balls of half a turn at rated torque.
    terms_arcsec : between ± T_L, in place of the backlash sum's terms (`pipeline.gear_terms`); empty where
        nobody asked.
    """

    K1_Nm_per_rad: float
    K2_Nm_per_rad: float
    K3_Nm_per_rad: float
    T1_Nm: float
    T2_Nm: float
    rated_torque_Nm: float
    lost_motion_arcsec: float
    teeth_in_contact: int
    compliance_shares: Mapping[str, float]
    torque_Nm: tuple[float, ...]
    angle_arcsec: tuple[float, ...]
    assumed: tuple[Assumed, ...]
    warnings: tuple[str, ...]
    notes: tuple[str, ...]
    preload_tooth_force_N: float
    tooth_angle_deg: tuple[float, ...]
    tooth_force_N: tuple[float, ...]
    ball_angle_deg: tuple[float, ...]
    ball_force_N: tuple[float, ...]
    terms_arcsec: Mapping[str, float] = field(default_factory=dict)


def gear_curve(context: AnalysisContext) -> GearCurve:
    """The whole answer of `flexspline gear`.

    Raises
    ------
    DesignError
    ComputationError
    """
    design, load = context.design, context.design.load

    K_e = part_stiffness(context.part("shaft")).K_Nm_per_rad

    def solve() -> GearCurve:
        chain = chain_of(context, K_e)
        with context.progress.stage("contact of teeth, rim, race and balls"), one_thread():
            terms = gear_terms(chain, load.torque_Nm, rated_torque(design)[0])
            return replace(curve_of(design, chain), terms_arcsec=terms)

    depends_on = {
        "flexspline": context.part("flexspline").revolved_key,
        "K_e_Nm_per_rad": K_e,  # as it was found: more time finds another
        "others": [design.gear, design.bearing, design.wave_generator, load],
    }
    return context.cache.get("gear", depends_on, solve)[0]


def curve_of(design: Design, chain: Chain) -> GearCurve:
    """K1 to K3, lost motion, the loop, and what carries at rated torque."""
    rated, assumed = rated_torque(design)
    up = rated * np.array(LOADING)
    states = chain.along(up.tolist())
    angles = np.array([chain.angle(s) for s in states])
    marks = [LOADING.index(share) for share in (LOADING[0], T1_SHARE, T2_SHARE, 1.0)]
    K1, K2, K3 = chords(up[marks], angles[marks])
    one_way = float(angles[LOADING.index(LOST_MOTION_SHARE)])
    full = states[-1]
    model = chain.model
    teeth = model.pair_forces(full)
    preload = _preload(model, states[0])
    carrying = np.abs(teeth) > CARRIES * np.abs(teeth).max()
    return GearCurve(
        K1_Nm_per_rad=K1,
        K2_Nm_per_rad=K2,
        K3_Nm_per_rad=K3,
        T1_Nm=T1_SHARE * rated,
        T2_Nm=T2_SHARE * rated,
        rated_torque_Nm=rated,
        lost_motion_arcsec=2 * one_way * ARCSEC_PER_RAD,
        teeth_in_contact=round(2 * float(carrying.sum()) * model.teeth_per_station),
        compliance_shares=chain.shares(full),
        torque_Nm=_loop(up),
        angle_arcsec=_loop(angles * ARCSEC_PER_RAD),
        assumed=(*assumed, *flexible_bearing(design).assumed, *LAWS),
        warnings=tuple(_warnings(design, model, preload)),
        notes=tuple(_notes(design, model, teeth)),
        preload_tooth_force_N=preload,
        tooth_angle_deg=tuple(np.degrees(model.tooth_angles).tolist()),
        tooth_force_N=tuple(teeth.tolist()),
        ball_angle_deg=tuple(np.degrees(model.wave_generator.angles).tolist()),
        ball_force_N=tuple(full.forces[model.balls].tolist()),
    )


def _loop(up: np.ndarray) -> tuple[float, ...]:
    """0 → full → −full → 0 from its first quarter."""
    there_and_back = [*up.tolist(), *up[-2::-1].tolist()]
    return (*there_and_back, *(-value for value in there_and_back))


def _preload(model: GearModel, unloaded: Equilibrium) -> float:
    """Largest force of a pair of teeth where both flanks press without torque [N]; 0 where one is free."""
    front, back = np.split(unloaded.loaded[model.flanks], 2)
    if not (front.any() and back.any()):
        return 0.0
    return float(unloaded.forces[model.flanks].max()) / model.teeth_per_station


def _warnings(design: Design, model: GearModel, preload_N: float) -> list[str]:
    """What makes the gear another one than was meant."""
    lines = []
    if preload_N:
        lines.append(
            f"teeth press on both flanks without torque, up to {_rounded(preload_N)} N each: "
            f"{_why_both_press(design, model)}"
        )
    rated, _ = rated_torque(design)
    if design.load.torque_Nm > BEYOND_RATED * rated:
        lines.append(
            f"load.torque_Nm = {design.load.torque_Nm:g} is {design.load.torque_Nm / rated:.3g} times the "
            "rated torque: teeth and rim are not elastic there"
        )
    return lines


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
    return "the flank clearance is too small"


def _notes(design: Design, model: GearModel, teeth: np.ndarray) -> list[str]:
    """What was simplified; `teeth` (t,) [N]: forces at rated torque."""
    lines = []
    balls = flexible_bearing(design).ball_count
    if even(balls) != balls:
        lines.append(f"{balls} balls are computed as {even(balls)}: both lobes have the same")
    mesh = model.mesh
    if mesh.largest_relief > 0:
        lines.append(
            f"plain flanks come closer again beyond {degrees(mesh.relieved_from):.0f}° from the major axis: "
            f"taken as relieved, by {_rounded(1e3 * mesh.largest_relief)} µm at {degrees(mesh.reach):.0f}°"
        )
    if design.flexspline.teeth == "drawn":
        lines.append(
            f"gaps are those of straight flanks of {design.gear.pressure_angle_deg:g}°, not of the drawn ones"
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
