"""The torque limit of the linear model: closed forms, linear in the torque."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import pi, sqrt
from typing import Literal

from flexspline.fea.types import NMM_PER_NM, StressPeak
from flexspline.geometry.design import Design
from flexspline.geometry.part_name import PartName
from flexspline.geometry.tube import polar_moment_mm4
from flexspline.pipeline.stress_limits import HIGHEST_STRENGTH_MPA, ON_ELLIPSE, PART_OF, is_compared


@dataclass(frozen=True)
class ToothTwist:
    """The twist reaches the pitch of one of so many teeth."""

    teeth: int


StressPlace = Literal["tube", "diaphragm", "shaft", "peak"]


@dataclass(frozen=True)
class ReachedStress:
    """Von Mises stress at a place of a part reaches `limit_MPa`: the fatigue limit, or HIGHEST_STRENGTH_MPA.

    `size_mm`: the radius in the diaphragm, the outer diameter of the shaft.
    """

    part: PartName
    place: StressPlace
    size_mm: float | None
    limit_MPa: float
    is_fatigue_limit: bool


@dataclass(frozen=True)
class LinearLimit:
    """A torque beyond which stiffness, stress and backlash by the linear model are not valid, and why.

    `results/limit_words.py` says it. `peaks_solved`: whether the peak stress of notches was asked too;
    `not_counted`: parts whose peak was, and says nothing of the part alone.
    """

    torque_Nm: float
    why: ToothTwist | ReachedStress
    peaks_solved: bool = True
    not_counted: tuple[PartName, ...] = ()


def linear_limit(
    design: Design, K_series_Nm_per_rad: float, peaks: Mapping[str, StressPeak] | None = None
) -> LinearLimit:
    """Return the least torque at which T/K reaches a tooth's pitch 2π/z1 or a stress its limit [N·m].

    Stresses are those that equilibrium alone gives in tube, diaphragm and shaft, and of `peaks` under the
    load torque (by their names in result.json) those that are the part's; None: they were not solved. Real
    limits lie lower: buckling, the teeth and bolts are not in it.
    """
    least = min(_limits(design, K_series_Nm_per_rad, peaks or {}), key=lambda x: x.torque_Nm)
    not_counted = tuple(
        PART_OF[name]
        for name, peak in (peaks or {}).items()
        if name != ON_ELLIPSE and not is_compared(name, peak)
    )
    return replace(least, peaks_solved=peaks is not None, not_counted=not_counted)


def _limits(design: Design, K: float, peaks: Mapping[str, StressPeak]) -> Iterator[LinearLimit]:
    teeth = design.gear.teeth_flexspline
    yield LinearLimit(2 * pi * K / teeth, ToothTwist(teeth))
    for part, place, size, stress in _nominal_mises(design):
        why = ReachedStress(part, place, size, *_limit(design, part))
        yield LinearLimit(why.limit_MPa / stress, why)
    for name, peak in peaks.items():
        if name != ON_ELLIPSE and is_compared(name, peak):
            part = PART_OF[name]
            why = ReachedStress(part, "peak", None, *_limit(design, part))
            yield LinearLimit(design.load.torque_Nm * why.limit_MPa / peak.mises_MPa, why)


def _limit(design: Design, part: PartName) -> tuple[float, bool]:
    """Stress [MPa] that a part bears at most, and whether that is its stated fatigue limit."""
    stated = design.part(part).material.fatigue_limit_MPa
    if stated is not None and stated <= HIGHEST_STRENGTH_MPA:
        return stated, True
    return HIGHEST_STRENGTH_MPA, False


def _nominal_mises(
    design: Design,
) -> Iterator[tuple[PartName, StressPlace, float | None, float]]:
    """Part, place, its size [mm], and von Mises stress √3·τ there per torque [MPa per N·m]: equilibrium."""
    f = design.flexspline
    yield "flexspline", "tube", None, _tube(f.wall_radius, f.inner_radius)
    inside = f.size(f.land_edge) / 2 if f.inward else f.wall_radius
    shear = NMM_PER_NM / (2 * pi * inside**2 * f.diaphragm_thickness_mm)
    yield "flexspline", "diaphragm", inside, sqrt(3) * shear
    for s in design.shaft.segment:
        outer, inner = s.outer_diameter_mm / 2, s.inner_diameter_mm / 2
        yield "shaft", "shaft", s.outer_diameter_mm, _tube(outer, inner)


def _tube(outer: float, inner: float) -> float:
    """Coulomb: τ = T R/J, at the outside."""
    return sqrt(3) * NMM_PER_NM * outer / polar_moment_mm4(outer, inner)
