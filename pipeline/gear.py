"""The whole gear with its wave generator locked: θ(T), and what the makers' catalogues say of such a curve.

K1 is the chord from 0 to T1, K2 from T1 to T2, K3 from T2 to rated torque, as in the makers'
catalogues; "0" is a thousandth of rated torque: a clearance that the teeth first cross is not
booked as softness. Lost motion is the whole twist between ± 4 % of rated torque, clearance
included. Friction is left out: loading and unloading are one curve.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import degrees

import numpy as np

from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.fea.gear.kinematics import LARGEST_WITHDRAWAL
from flexspline.fea.gear.model import GearModel
from flexspline.fea.threads import one_thread
from flexspline.fea.types import NMM_PER_NM
from flexspline.geometry.design import Design
from flexspline.geometry.rated import rated_torque
from flexspline.geometry.wave_generator import Assumed, flexible_bearing
from flexspline.pipeline import revolved
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.enclosed_part import tolerance_of
from flexspline.pipeline.gear_model import CONFORMITY, even, gear_model
from flexspline.pipeline.part_stiffness import part_stiffness
from flexspline.pipeline.parts import AnalysisContext

T1_SHARE, T2_SHARE = 0.15, 0.50
"""Of rated torque: the makers' T1 and T2 are 0.13 to 0.20 and 0.39 to 0.69 of it in those four sizes."""
LOST_MOTION_SHARE = 0.04
"""Of rated torque, each way (GB/T 35089-2018; Hrcek et al., Materials 14 (2021) 5057)."""
LOADING = (0.001, LOST_MOTION_SHARE, 0.09, T1_SHARE, 0.25, 0.37, T2_SHARE, 0.66, 0.83, 1.0)
"""Torques of a quarter of the loop, of rated torque; a chord "from 0" begins at the first."""
LAWS = (
    Assumed("T1 over rated torque", T1_SHARE, "makers': 0.13 to 0.20"),
    Assumed("T2 over rated torque", T2_SHARE, "makers': 0.39 to 0.69"),
    Assumed("groove radius over ball diameter", CONFORMITY, "usual in deep groove bearings"),
    Assumed("working depth over m(z2 - z1)/2", LARGEST_WITHDRAWAL, "teeth of full height"),
)
"""What no key of the design file states."""
LOW_RIM = 0.05
"""Of the stroke: play that lowers the rim by more takes clearance from teeth off the major axis."""
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
    warnings : one line each.
    tooth_angle_deg, tooth_force_N : teeth within reach of one lobe at rated torque, front less back flank.
    ball_angle_deg, ball_force_N : balls of half a turn at rated torque.
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
    tooth_angle_deg: tuple[float, ...]
    tooth_force_N: tuple[float, ...]
    ball_angle_deg: tuple[float, ...]
    ball_force_N: tuple[float, ...]


def chords(torques_Nm: Sequence[float] | np.ndarray, angles_rad: np.ndarray) -> tuple[float, ...]:
    """Stiffness [N·m/rad] between each torque and the next."""
    return tuple((np.diff(torques_Nm) / np.diff(angles_rad)).tolist())


@dataclass(frozen=True)
class Chain:
    """The contact model with what stands behind it in series.

    `shaft`, `holes`: compliance of the shaft, and what bolt holes add to the flexspline's [rad/(N·m)].
    """

    model: GearModel
    shaft: float
    holes: float

    def angle(self, at: Equilibrium) -> float:
        """Rotation of the output [rad]."""
        return at.rotation + self.torque_Nm(at) * (self.shaft + self.holes)

    @staticmethod
    def torque_Nm(at: Equilibrium) -> float:
        """On the whole gear; an equilibrium's is that of one half [N·mm]."""
        return 2 * at.torque / NMM_PER_NM

    def along(self, torques_Nm: Sequence[float]) -> list[Equilibrium]:
        """One after the other, each begun from the one before.

        Raises
        ------
        EquilibriumError
        """
        found: list[Equilibrium] = []
        for torque in torques_Nm:
            found.append(self.model.at_torque(torque, found[-1].forces if found else None))
        return found

    def angles(self, torques_Nm: Sequence[float]) -> np.ndarray:
        """Of the output [rad]; errors as `along`."""
        return np.array([self.angle(at) for at in self.along(torques_Nm)])

    def shares(self, at: Equilibrium) -> dict[str, float]:
        """Of dθ/dT, in the order in which torque passes."""
        parts = {k: v * NMM_PER_NM for k, v in self.model.compliance_of(at).items()}
        parts["flexspline"] += self.holes
        parts["shaft"] = self.shaft
        total = sum(parts.values())
        return {key: parts[key] / total for key in ("flexspline", "shaft", "teeth", "bearing")}


def chain_of(context: AnalysisContext) -> Chain:
    """A design's contact model, its shaft and its bolt holes.

    Bolt holes enter by K_b of the case `uniform`: 1/K with the holes less 1/K without.

    Raises
    ------
    DesignError
    ComputationError
    """
    flexspline = context.part("flexspline")
    with context.progress.stage("flexspline, condensed to its teeth and its seat"):
        model = gear_model(context.design, flexspline.part)
    holes = 0.0
    if flexspline.part.bolts is not None:
        own, filled = (
            revolved.torsion(part, tolerance_of(flexspline)).K_Nm_per_rad
            for part in (flexspline.part, flexspline.part.without_holes())
        )
        holes = max(0.0, 1 / own - 1 / filled)
    return Chain(model, 1 / part_stiffness(context.part("shaft")).K_Nm_per_rad, holes)


def gear_curve(context: AnalysisContext) -> GearCurve:
    """The whole answer of `flexspline gear`.

    Raises
    ------
    DesignError
    ComputationError
    """
    chain = chain_of(context)
    with context.progress.stage("contact of teeth, rim, race and balls"), one_thread():
        return curve_of(context.design, chain)


def curve_of(design: Design, chain: Chain) -> GearCurve:
    """K1 to K3, lost motion, the loop, and what carries at rated torque."""
    rated, assumed = rated_torque(design)
    up = rated * np.array(LOADING)
    loop = np.concatenate([up, up[-2::-1], -up, -up[-2::-1]])
    states = chain.along(loop.tolist())
    angles = np.array([chain.angle(s) for s in states])
    marks = [LOADING.index(share) for share in (LOADING[0], T1_SHARE, T2_SHARE, 1.0)]
    K1, K2, K3 = chords(loop[marks], angles[marks])
    one_way = LOADING.index(LOST_MOTION_SHARE)
    other_way = 2 * len(up) - 1 + one_way
    full = states[len(up) - 1]
    model = chain.model
    teeth = model.pair_forces(full)
    carrying = np.abs(teeth) > CARRIES * np.abs(teeth).max()
    return GearCurve(
        K1_Nm_per_rad=K1,
        K2_Nm_per_rad=K2,
        K3_Nm_per_rad=K3,
        T1_Nm=T1_SHARE * rated,
        T2_Nm=T2_SHARE * rated,
        rated_torque_Nm=rated,
        lost_motion_arcsec=float(angles[one_way] - angles[other_way]) * ARCSEC_PER_RAD,
        teeth_in_contact=round(2 * float(carrying.sum()) * model.teeth_per_station),
        compliance_shares=chain.shares(full),
        torque_Nm=tuple(loop.tolist()),
        angle_arcsec=tuple((angles * ARCSEC_PER_RAD).tolist()),
        assumed=(*assumed, *flexible_bearing(design).assumed, *LAWS),
        warnings=tuple(_warnings(design, model, states)),
        tooth_angle_deg=tuple(np.degrees(model.tooth_angles).tolist()),
        tooth_force_N=tuple(teeth.tolist()),
        ball_angle_deg=tuple(np.degrees(model.wave_generator.angles).tolist()),
        ball_force_N=tuple(full.forces[model.balls].tolist()),
    )


def _warnings(design: Design, model: GearModel, states: Sequence[Equilibrium]) -> list[str]:
    lines = []
    balls = flexible_bearing(design).ball_count
    if even(balls) != balls:
        lines.append(f"{balls} balls are computed as {even(balls)}: both lobes have the same")
    mesh = model.mesh
    if mesh.largest_relief > 0:
        lines.append(
            f"plain flanks come closer again beyond {degrees(mesh.relieved_from):.0f}° from the major "
            f"axis: taken as relieved, by {1e3 * mesh.largest_relief:.2g} µm at {degrees(mesh.reach):.0f}°"
        )
    unloaded = states[0]
    front, back = np.split(unloaded.loaded[model.flanks], 2)
    if front.any() and back.any():
        force = float(unloaded.forces[model.flanks].max()) / model.teeth_per_station
        play = design.bearing.radial_clearance_um / 2e3
        lowered = play > LOW_RIM * model.wave_generator.deflection
        why = (
            f"half the play, {play:.3g} mm, lowers the rim's stroke of "
            f"{model.wave_generator.deflection:.3g} mm, and teeth off the major axis no longer clear"
            if lowered
            else "there is no clearance"
        )
        lines.append(f"teeth press on both flanks without torque, up to {force:.2g} N each: {why}")
    teeth = np.abs(model.pair_forces(states[len(LOADING) - 1]))
    most = int(teeth.argmax())
    if most in (0, len(teeth) - 1):
        lines.append(
            f"the pair of teeth that carries most stands {abs(degrees(model.tooth_angles[most])):.0f}° from "
            "the major axis, at the end of the working depth that is assumed: its force hangs on that end"
        )
    return lines
