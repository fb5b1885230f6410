"""Notes and warnings on the whole gear as facts; `results/gear_words.py` puts them into words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class WrongStroke:
    """The plug's stroke is not m(z2 − z1)/2."""

    stroke_mm: float
    full_mm: float


@dataclass(frozen=True)
class LowRim:
    """Half the play lowers the rim's stroke."""

    half_play_mm: float
    stroke_mm: float


@dataclass(frozen=True)
class TightFlanks:
    """Where front and back flanks press most, from the major axis; the clearance is too small there."""

    front_deg: float
    back_deg: float


@dataclass(frozen=True)
class PressingFlanks:
    """Teeth press on both flanks without torque, the most loaded with that force."""

    force_N: float
    why: WrongStroke | LowRim | Literal["flanks_cut"] | TightFlanks


@dataclass(frozen=True)
class CuttingFlanks:
    """Flanks overlap from an angle off the major axis on, by the most at another.

    `clear_depth_mm`: the working depth within which they do not; None where it is too shallow.
    """

    shape: str
    from_deg: float
    overlap_um: float
    most_deg: float
    clear_depth_mm: float | None


@dataclass(frozen=True)
class LoadBeyondRated:
    """The load is far beyond rated torque, where nothing is elastic."""

    load_Nm: float
    rated_Nm: float


@dataclass(frozen=True)
class EarlyEnd:
    """An estimated end is below rated torque."""

    end: Literal["ratchets", "buckles"]
    torque_Nm: float
    rated_Nm: float


GearWarning = (
    PressingFlanks | CuttingFlanks | LoadBeyondRated | EarlyEnd | Literal["play_closes_gap"]
)
"""Reasons why a gear is not the intended one; the plain text: more play makes the free angle smaller."""


@dataclass(frozen=True)
class HalvedBalls:
    """The number of balls that are computed, half of them in each lobe."""

    count: int
    computed: int


@dataclass(frozen=True)
class LowRatio:
    """Below that ratio the model is too stiff."""

    limit: float


@dataclass(frozen=True)
class RelievedFlanks:
    """Relief is assumed where straight flanks come closer again, beyond an angle from the major axis."""

    from_deg: float
    removed_um: float
    end_deg: float


@dataclass(frozen=True)
class ShapedFaces:
    """Teeth shaped for the rim's cone, up to so much at the ends of their face."""

    removed_um: float


@dataclass(frozen=True)
class StraightFlanks:
    """Gaps are those of straight flanks, not of the drawn ones."""

    pressure_angle_deg: float


@dataclass(frozen=True)
class LoadedLastPair:
    """The last pair of teeth within the working depth carries much."""

    at_deg: float


@dataclass(frozen=True)
class TwoTorques:
    """Terms and lost motion are not of one torque."""

    load_Nm: float
    lost_motion_Nm: float


@dataclass(frozen=True)
class JointClearances:
    """Free angle that the play alone opens, and what the terms leave to it, as flanks come first."""

    play_alone_arcsec: float
    play_term_arcsec: float


@dataclass(frozen=True)
class FallingStiffness:
    """A chord is less stiff than the one before, by this share; the force without torque, or 0."""

    lower: str
    higher: str
    share: float
    preload_N: float


@dataclass(frozen=True)
class BucklingTube:
    """Torque and shear stress at which it buckles."""

    torque_Nm: float
    stress_MPa: float


PlainGearNote = Literal[
    "play_beside_stroke",
    "no_ratcheting",
    "ratcheting_is_upper",
    "tube_yields_first",
    "tube_buckles_first",
    "both_limits_alike",
]
"""Notes without figures: play reduces the free angle because the stroke is not full; the gear ratchets at no
torque, or its ratcheting torque is an upper limit; the tube yields before it buckles, or buckles before the
gear ratchets; the two torques are equal in two digits."""

GearNote = (
    HalvedBalls
    | LowRatio
    | RelievedFlanks
    | ShapedFaces
    | StraightFlanks
    | LoadedLastPair
    | TwoTorques
    | JointClearances
    | FallingStiffness
    | BucklingTube
    | PlainGearNote
)
"""Simplifications, and how to read the figures."""
