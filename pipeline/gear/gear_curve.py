"""The whole gear with its wave generator locked: θ(T), and the values that catalogues give for it.

K1 is the chord from 0 to T1, K2 from T1 to T2, K3 from T2 to rated torque, as in the makers'
catalogues; "0" is a thousandth of rated torque: a clearance that the teeth first cross is not
booked as softness. Lost motion is the whole twist between ± `LOST_MOTION_SHARE` of rated
torque, clearance included. Friction is left out, so loading and unloading are one curve; and both
lobes are alike and teeth and balls stand alike on both sides of them, so the curve is odd. Positive
torques are computed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from flexspline.fea.gear.engagement import Engagement
from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.fea.threads import one_thread
from flexspline.geometry.assumed import Assumed
from flexspline.geometry.design import Design
from flexspline.geometry.gear_assumptions import gear_assumptions
from flexspline.geometry.rated import LOST_MOTION_SHARE, rated_in_proportion, rated_torque
from flexspline.geometry.whole_gear import require_whole_gear
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.gear.gear_chain import Chain, chain_of, chords
from flexspline.pipeline.gear.gear_model import CONFORMITY
from flexspline.pipeline.gear.gear_notes import (
    both_press_N,
    notes,
    of_chords,
    of_play,
    of_torques,
    warnings,
)
from flexspline.pipeline.gear.gear_remarks import GearNote, GearWarning
from flexspline.pipeline.gear.gear_terms import (
    FREE_ANGLE_TERMS,
    gear_terms,
    play_effect,
    small_torque,
)
from flexspline.pipeline.gear.largest_torques import (
    buckling_torque,
    largest_torques,
    tube_of,
    two_digits,
)
from flexspline.pipeline.part_stiffness import part_stiffness
from flexspline.pipeline.parts import AnalysisContext

T1_SHARE, T2_SHARE = 0.15, 0.50
"""T1 and T2 over rated torque. In makers' catalogues T1 is 0.13 to 0.20 and T2 0.39 to 0.69 of rated torque
(sizes 14 to 25)."""
BELOW_T1 = (0.001, 0.005, 0.01, 0.015, 0.025, LOST_MOTION_SHARE, 0.05, 0.065, 0.09, 0.12)
"""Torques over rated torque, up to T1. In this range teeth come into contact and the curve bends; the lost
motion is read here."""
BELOW_T2 = (T1_SHARE, 0.2, 0.25, 0.31, 0.37, 0.43)
"""Torques over rated torque from T1 up to T2, the range of K2."""
LOADING = (*BELOW_T1, *BELOW_T2, T2_SHARE, 0.58, 0.66, 0.74, 0.83, 0.91, 1.0)
"""All torques that are computed, over rated torque; a chord "from 0" begins at the first. Straight lines
between them deviate by less than 0.2 % of the wind-up on the gears tried, because further teeth come into
contact along the whole curve."""
LAWS = (
    Assumed("T1 over rated torque", T1_SHARE, "makers': 0.13 to 0.20"),
    Assumed("T2 over rated torque", T2_SHARE, "makers': 0.39 to 0.69"),
    Assumed("groove radius over ball diameter", CONFORMITY, "usual in deep groove bearings"),
)
"""Assumptions that no key of the design file states."""
CARRYING_SHARE = 1e-3
"""A tooth with less than this share of the largest force does not count as in contact."""


@dataclass(frozen=True)
class GearCurve:
    """The torque-angle curve of the gear's output, and its figures.

    Attributes
    ----------
    torque_Nm, angle_arcsec : the loop 0 → rated → −rated → 0, but for 0 itself, where a gear with clearance
        has no angle of its own.
    compliance_shares : of flexspline, shaft, teeth and bearing in dθ/dT at rated torque; they add up to 1.
    assumed : each value that the design file does not state.
    warnings : what makes it another gear than was meant; `notes` : what was simplified.
    preload_tooth_force_N : largest force of a pair of teeth without torque, where both flanks press; else 0.
    tooth_angle_deg, tooth_force_N : stations within reach of one lobe, and the force of a pair of teeth at
        each, front less back flank, at rated torque.
    ball_angle_deg, ball_force_N : balls of half a turn at rated torque.
    terms_arcsec : between ± `terms_torque_Nm`, T_L, in place of the backlash sum's terms
        (`pipeline.gear.gear_terms`); empty where nobody asked.
    buckling_torque_Nm : an estimate, of the flexspline's tube (`fea.gear.tube_buckling`); None: no tube, or
        it yields first.
    ratcheting_torque_Nm : an estimate, where the load has pressed all teeth out of their spaces
        (`fea.gear.engagement`); None where nobody asked, or where they hold at 16 000 times
        the rated torque of a gear of this size.
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
    warnings: tuple[GearWarning, ...]
    notes: tuple[GearNote, ...]
    preload_tooth_force_N: float
    tooth_angle_deg: tuple[float, ...]
    tooth_force_N: tuple[float, ...]
    ball_angle_deg: tuple[float, ...]
    ball_force_N: tuple[float, ...]
    terms_arcsec: Mapping[str, float] = field(default_factory=dict)
    terms_torque_Nm: float | None = None
    buckling_torque_Nm: float | None = None
    ratcheting_torque_Nm: float | None = None

    @property
    def lost_motion_torque_Nm(self) -> float:
        """Torque of the lost motion, each way."""
        return LOST_MOTION_SHARE * self.rated_torque_Nm

    @property
    def free_angle_arcsec(self) -> float | None:
        """Free angle between both flanks, which K1 leaves out; None without the terms."""
        if not self.terms_arcsec:
            return None
        return sum(self.terms_arcsec[term] for term in FREE_ANGLE_TERMS)


def gear_curve(context: AnalysisContext) -> GearCurve:
    """Return the whole answer of `flexspline gear`.

    Raises
    ------
    DesignError
    ComputationError
    """
    design, load = context.design, context.design.load
    require_whole_gear(design)
    K_e = part_stiffness(context.part("shaft")).K_Nm_per_rad

    def solve() -> GearCurve:
        chain = chain_of(context, K_e)
        with context.progress.stage("contact of teeth, rim, race and balls"), one_thread():
            rated, _ = rated_torque(design)
            start = chain.model.at_torque(small_torque(load.torque_Nm, rated))
            terms = gear_terms(chain, load.torque_Nm, start)
            play = play_effect(chain.model, start)
            curve = curve_of(design, chain, start)
        with context.progress.stage("ratcheting torque"), one_thread():
            limit = Engagement(chain.model).limit(rated_in_proportion(design.gear.pitch_radius_mm))
        tube = tube_of(design)
        full = chain.model.wave_generator.deflection == design.gear.centre_distance_mm
        of_load = of_torques(load.torque_Nm, LOST_MOTION_SHARE * rated)
        play_warned, play_noted = of_play(terms, play, full)
        end_warned, end_noted = largest_torques(limit, tube, rated)
        return replace(
            curve,
            terms_arcsec=terms,
            terms_torque_Nm=load.torque_Nm,
            buckling_torque_Nm=buckling_torque(tube),
            ratcheting_torque_Nm=limit and two_digits(limit),  # found to 5 %
            warnings=(*curve.warnings, *play_warned, *end_warned),
            notes=(*curve.notes, *of_load, *play_noted, *end_noted),
        )

    depends_on = {
        "flexspline": context.part("flexspline").revolved_key,
        "K_e_Nm_per_rad": K_e,  # as it was found: more time finds another
        "torques": list(LOADING),
        "others": [design.gear, design.bearing, design.wave_generator, load],
        "materials": [design.material.circular_spline, design.material.bearing],
    }
    return context.cache.get("gear", depends_on, solve)[0]


def curve_of(design: Design, chain: Chain, start: Equilibrium | None = None) -> GearCurve:
    """Return K1 to K3, lost motion, the loop, and the loads at rated torque; `start`: at a small torque."""
    rated, _ = rated_torque(design)
    up = rated * np.array(LOADING)
    states = chain.along(up.tolist(), start)
    angles = np.array([chain.angle(s) for s in states])
    marks = [LOADING.index(share) for share in (LOADING[0], T1_SHARE, T2_SHARE, 1.0)]
    K1, K2, K3 = chords(up[marks], angles[marks])
    preload_N = both_press_N(chain.model, states[0])
    one_way = float(angles[LOADING.index(LOST_MOTION_SHARE)])
    full = states[-1]
    model = chain.model
    teeth = model.pair_forces(full)
    carrying = np.abs(teeth) > CARRYING_SHARE * np.abs(teeth).max()
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
        assumed=(*gear_assumptions(design), *LAWS),
        warnings=tuple(warnings(design, model, states[0])),
        notes=(*notes(design, model, teeth), *of_chords((K1, K2, K3), preload_N)),
        preload_tooth_force_N=preload_N,
        tooth_angle_deg=tuple(np.degrees(model.tooth_angles).tolist()),
        tooth_force_N=tuple(teeth.tolist()),
        ball_angle_deg=tuple(np.degrees(model.wave_generator.angles).tolist()),
        ball_force_N=tuple(full.forces[model.balls].tolist()),
    )


def _loop(up: np.ndarray) -> tuple[float, ...]:
    """0 → full → −full → 0 from its first quarter."""
    there_and_back = [*up.tolist(), *up[-2::-1].tolist()]
    return (*there_and_back, *(-value for value in there_and_back))
