"""The four-term backlash sum, its standard deviation, and the torque-angle line that it implies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, hypot, isfinite, pi, radians

import numpy as np

from flexspline.geometry.design import Design
from flexspline.geometry.errors import FlexsplineError, short
from flexspline.geometry.fields import MM_PER_UM
from flexspline.pipeline.bearing_play import (
    BearingPlayDomainError,
    involute_clearance,
    small_displacement_clearance,
)
from flexspline.pipeline.play_spread import play_spread

ARCSEC_PER_RAD = 180 * 3600 / pi
"""A half turn has π rad, and 180° of 3600 arcsec."""
TERMS = ("shaft", "flexspline", "flank_clearance", "bearing_play")
"""Of the sum, in its order."""
STD_KEY = "backlash_arcsec.std"
"""Of the sum's standard deviation, in records and studies."""


def series_compliance(K_b: float, K_e: float) -> float:
    """Return 1/K_e + 1/K_b [rad/(N·m)] of flexspline and shaft in series; both K in N·m/rad."""
    return 1 / K_e + 1 / K_b


def series_stiffness(K_b: float, K_e: float) -> float:
    """Return K [N·m/rad] of flexspline and shaft in series: see `series_compliance`."""
    return 1 / series_compliance(K_b, K_e)


class StiffnessValueError(FlexsplineError, ValueError):
    """A stiffness that is not a positive number; `name`, `value` [N·m/rad]."""

    def __init__(self, name: str, value: object) -> None:
        self.name, self.value = name, value
        super().__init__(
            f"{name} = {short(value)}: must be a number of N·m/rad, above 0 and finite"
        )


def require_stiffness(name: str, value: object) -> None:
    """Refuse what is no stiffness [N·m/rad]; `name` is what the refusal calls it.

    Raises
    ------
    StiffnessValueError : no number, or one that is not positive and finite.
    """
    try:
        good = isfinite(value) and value > 0 and not isinstance(value, bool | np.bool_)  # type: ignore[arg-type, operator]
    except (TypeError, OverflowError):  # text, or a whole number that no double holds
        good = False
    if not good:
        raise StiffnessValueError(name, value)


@dataclass(frozen=True)
class Backlash:
    """The sum and what it may be off by; arcsec.

    Attributes
    ----------
    shaft_arcsec, flexspline_arcsec : wind-up between −T_L and +T_L, 2T_L/K.
    flank_clearance_arcsec, bearing_play_arcsec : the two parts of the gap.
    total_arcsec : their sum.
    std_arcsec : one standard deviation of the total, from `[uncertainty]` alone; None where the
        design states none.
    std_by_source_arcsec : its independent parts, by the source of doubt, those that are stated.
    play_beyond_limit : probability that the play lies beyond the involute model's end, where
        `std_arcsec` cannot answer for it; 0 for the small-displacement model.
    model_form_arcsec : total with the other bearing-play model, less this total; None where the
        other model has no answer.
    """

    shaft_arcsec: float
    flexspline_arcsec: float
    flank_clearance_arcsec: float
    bearing_play_arcsec: float
    total_arcsec: float
    std_arcsec: float | None
    std_by_source_arcsec: Mapping[str, float]
    play_beyond_limit: float
    model_form_arcsec: float | None

    @property
    def terms_arcsec(self) -> Mapping[str, float]:
        """The four terms by name, in the sum's order."""
        return {term: getattr(self, f"{term}_arcsec") for term in TERMS}

    @property
    def gap_arcsec(self) -> float:
        """Free angle of flank clearance and bearing play together."""
        return self.flank_clearance_arcsec + self.bearing_play_arcsec


def windup(torque_Nm: float, stiffness_Nm_per_rad: float) -> float:
    """Return the wind-up between −T and +T of one spring, 2T/K [rad].

    Parameters: T [N·m], K [N·m/rad], both positive. Source: article, section 1.1.

    Examples
    --------
    Article, table 2: 0.5 N·m on 1.8e4 N·m/rad, "11.5″":

    >>> round(windup(0.5, 1.8e4) * ARCSEC_PER_RAD, 2)
    11.46
    """
    return 2 * torque_Nm / stiffness_Nm_per_rad


def gap_angle(normal_clearance: float, module: float, teeth: int, pressure_angle: float) -> float:
    """Return the output angle that a normal flank clearance leaves free, 2j/(m z1 cos α) [rad].

    Parameters: j [mm], m [mm], z1, α [rad]. Source: article, section 1.2.

    Examples
    --------
    Article, table 3: 3 µm at module 0.2, 200 teeth, 20°, "32.9″":

    >>> round(gap_angle(0.003, 0.2, 200, radians(20)) * ARCSEC_PER_RAD, 2)
    32.93
    """
    return 2 * normal_clearance / (module * teeth * cos(pressure_angle))


def backlash(design: Design, K_b_Nm_per_rad: float, K_e_Nm_per_rad: float) -> Backlash:
    """Return the four terms for a design whose flexspline and shaft have the given stiffness [N·m/rad].

    Δ_bl = 2T_L/K_e + 2T_L/K_b + 2(j_bn0 + j′)/(m z1 cos α). Young's modulus is one for both parts'
    doubt: its standard deviation acts on both compliances alike. The three sources are independent.

    Raises
    ------
    StiffnessValueError : a stiffness that is not positive and finite.
    BearingPlayDomainError : bearing play beyond c_max (involute model).
    """
    require_stiffness("K_b", K_b_Nm_per_rad)
    require_stiffness("K_e", K_e_Nm_per_rad)
    torque, doubt = design.load.torque_Nm, design.uncertainty
    shaft = windup(torque, K_e_Nm_per_rad)
    flexspline = windup(torque, K_b_Nm_per_rad)
    flank = clearance_angle(design, design.gear.flank_clearance_mm)
    play = clearance_angle(design, play_clearance(design))
    total = shaft + flexspline + flank + play
    play_std, beyond = play_spread(design.gear, design.bearing, doubt.radial_clearance_um)
    every = {
        "youngs_modulus": (shaft + flexspline) * doubt.youngs_modulus_pct / 100,
        "flank_clearance": clearance_angle(design, doubt.flank_clearance_um * MM_PER_UM),
        "radial_clearance": clearance_angle(design, play_std),
    }
    std = {source: every[source] for source in doubt.stated}
    other = _other_play_clearance(design)
    return Backlash(
        shaft_arcsec=shaft * ARCSEC_PER_RAD,
        flexspline_arcsec=flexspline * ARCSEC_PER_RAD,
        flank_clearance_arcsec=flank * ARCSEC_PER_RAD,
        bearing_play_arcsec=play * ARCSEC_PER_RAD,
        total_arcsec=total * ARCSEC_PER_RAD,
        std_arcsec=hypot(*std.values()) * ARCSEC_PER_RAD if std else None,
        std_by_source_arcsec={k: v * ARCSEC_PER_RAD for k, v in std.items()},
        play_beyond_limit=beyond,
        model_form_arcsec=None
        if other is None
        else (clearance_angle(design, other) - play) * ARCSEC_PER_RAD,
    )


def play_clearance(design: Design, model: str | None = None, play_um: float | None = None) -> float:
    """Normal clearance j′ [mm] of bearing play: the design's or `play_um`, by its model or by the one named.

    Raises
    ------
    BearingPlayDomainError : bearing play beyond c_max (involute model).
    """
    play = design.bearing.radial_clearance_mm if play_um is None else play_um * MM_PER_UM
    alpha = radians(design.gear.pressure_angle_deg)
    if (model or design.bearing.bearing_play_model) == "small_displacement":
        return small_displacement_clearance(play, alpha)
    return involute_clearance(play, design.gear.centre_distance_mm, alpha)


def gap_rad(design: Design) -> float:
    """Return the whole angular gap at the output, 2(j_bn0 + j′)/(m z1 cos α) [rad].

    Raises
    ------
    BearingPlayDomainError : bearing play beyond c_max (involute model).
    """
    return clearance_angle(design, design.gear.flank_clearance_mm + play_clearance(design))


def angle_rad(
    design: Design,
    torque_Nm: float | np.ndarray,
    K_b_Nm_per_rad: float,
    K_e_Nm_per_rad: float,
) -> np.ndarray:
    """The torque-angle line θ = T(1/K_e + 1/K_b) + sign(T)·gap/2 [rad], same shape as torque [N·m].

    Its ends at ±T_L are the four-term sum apart; at T = 0 the output may lie anywhere in the gap,
    and the middle is returned.

    Raises
    ------
    StiffnessValueError : a stiffness that is not positive and finite.
    BearingPlayDomainError : bearing play beyond c_max (involute model).
    """
    require_stiffness("K_b", K_b_Nm_per_rad)
    require_stiffness("K_e", K_e_Nm_per_rad)
    torque = np.asarray(torque_Nm, float)
    compliance = series_compliance(K_b_Nm_per_rad, K_e_Nm_per_rad)
    return torque * compliance + np.sign(torque) * gap_rad(design) / 2


def clearance_angle(design: Design, normal_clearance: float) -> float:
    """Return the output angle [rad] that a normal flank clearance [mm] leaves free in a design."""
    g = design.gear
    return gap_angle(
        normal_clearance, g.module_mm, g.teeth_flexspline, radians(g.pressure_angle_deg)
    )


def _other_play_clearance(design: Design) -> float | None:
    involute = design.bearing.bearing_play_model == "involute"
    try:
        return play_clearance(design, "small_displacement" if involute else "involute")
    except BearingPlayDomainError:
        return None
