"""The whole gear's equivalent of each term of the four-term backlash sum, between −T_L and +T_L."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.fea.gear.model import GearModel
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.gear.gear_chain import Chain

SMALL = 1e-3
"""Share of the smaller of load torque and rated torque: enough to close all gaps, with almost no wind-up."""
ARCSEC_DIGITS = 6
"""Decimals of an angle in arcsec: an equilibrium is found to about 1e-9 from any initial state."""
TIGHT = "tight_gear"
"""Name of the gap that remains without any clearance; the backlash sum has no term for it."""
FREE_ANGLE_TERMS = ("flank_clearance", "bearing_play", TIGHT)
"""Terms that make up the free angle."""
LAST_SHARE = 0.1
"""Share of the play that is removed last, to get the slope at the drawn play. It is small, but its effect is
still far above the rounding of an equilibrium."""


def small_torque(load_Nm: float, rated_Nm: float) -> float:
    """Return the torque at which the gear's gaps are taken [N·m]."""
    return SMALL * min(load_Nm, rated_Nm)


def gear_terms(chain: Chain, load_Nm: float, start: Equilibrium) -> Mapping[str, float]:
    """Return the twist's terms [arcsec]: shaft, flexspline, flank_clearance, bearing_play, tight_gear, total.

    `start`: the gear at its `small_torque`. "flexspline" is the wind-up of flexspline, teeth and bearing
    together. A clearance is what the free angle loses when first the flanks', then the bearing's is taken
    away; "tight_gear" is what is left: balls and rim yield, and the rim is no ideal ellipse.

    Raises
    ------
    EquilibriumError
    """
    model = chain.model
    tight = replace(model.mesh, clearance=0.0)
    no_flank = model.with_gaps(tight, model.wave_generator)
    no_play = model.with_gaps(tight, replace(model.wave_generator, play=0.0))

    loaded = Chain(model, 0.0, chain.holes).angle(model.at_torque(load_Nm, start))
    gap = free_angle(start)
    without_flank, without_any = (free_angle(of.like(start)) for of in (no_flank, no_play))
    terms = {
        "shaft": 2 * load_Nm * chain.shaft * ARCSEC_PER_RAD,
        "flexspline": 2 * ARCSEC_PER_RAD * loaded - gap,
        "flank_clearance": gap - without_flank,
        "bearing_play": without_flank - without_any,
        TIGHT: without_any,
    }
    # a difference of equal angles is what both solutions leave open, and has no sign
    return {
        key: round(v, ARCSEC_DIGITS) + 0.0
        for key, v in {**terms, "total": sum(terms.values())}.items()
    }


def free_angle(at: Equilibrium) -> float:
    """Return the angle between both flanks [arcsec], where the tangent at a small torque meets zero."""
    return 2 * ARCSEC_PER_RAD * (at.rotation - at.slope * at.torque)


@dataclass(frozen=True)
class PlayEffect:
    """Effect of the bearing's play on the free angle [arcsec]: of all of it, and of its last tenth alone."""

    whole: float
    last_tenth: float


def play_effect(model: GearModel, start: Equilibrium) -> PlayEffect:
    """Return the effect of the play while the flanks keep their clearance; errors as `gear_terms`."""

    def with_play(share: float) -> float:
        bearing = replace(model.wave_generator, play=share * model.wave_generator.play)
        return free_angle(model.with_gaps(model.mesh, bearing).like(start))

    as_drawn = free_angle(start)
    return PlayEffect(as_drawn - with_play(0.0), as_drawn - with_play(1 - LAST_SHARE))
