"""Up to which torque the linear model means anything: closed forms, linear in the torque."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import pi, sqrt

from flexspline.fea.types import NMM_PER_NM, StressPeak
from flexspline.geometry.design import Design
from flexspline.geometry.part_name import PartName
from flexspline.geometry.tube import polar_moment_mm4
from flexspline.pipeline.stress_limits import HIGHEST_STRENGTH_MPA, PART_OF

NOT_SOLVED = (
    "without the peak stress of notches, which `flexspline run` solves and which may end it earlier"
)


@dataclass(frozen=True)
class LinearLimit:
    """A torque beyond which stiffness, stress and backlash by the linear model are not valid, and why."""

    torque_Nm: float
    reason: str

    def passed(self, design: Design) -> Iterator[str]:
        """A line where the load torque is beyond it."""
        if design.load.torque_Nm > self.torque_Nm:
            yield (
                f"load.torque_Nm = {design.load.torque_Nm:g} is beyond {self.torque_Nm:.3g} N·m, where "
                f"{self.reason}: the linear model is not valid there"
            )


def linear_limit(
    design: Design, K_series_Nm_per_rad: float, peaks: Mapping[str, StressPeak] | None = None
) -> LinearLimit:
    """The least of the torques at which the twist T/K reaches a tooth's pitch 2π/z1 or a stress its limit.

    Stresses are those that equilibrium alone gives in tube, diaphragm and shaft, and of `peaks` under the
    load torque (by their names in result.json) those that are the part's; None: they were not solved, and
    the reason says so. Real limits lie lower: buckling, the teeth and bolts are not in it.
    """
    least = min(_limits(design, K_series_Nm_per_rad, peaks or {}), key=lambda x: x.torque_Nm)
    if peaks is None:
        return replace(least, reason=f"{least.reason} ({NOT_SOLVED})")
    return least


def _limits(design: Design, K: float, peaks: Mapping[str, StressPeak]) -> Iterator[LinearLimit]:
    teeth = design.gear.teeth_flexspline
    yield LinearLimit(2 * pi * K / teeth, f"the twist reaches one tooth, 360°/{teeth}")
    for part, where, stress in _nominal_mises(design):
        limit, words = _limit(design, part)
        yield LinearLimit(limit / stress, f"the stress of {where} reaches {words}")
    for name, peak in peaks.items():
        if name != "wave_generator_peak" and not peak.at_excluded_border:
            limit, words = _limit(design, PART_OF[name])
            torque = design.load.torque_Nm * limit / peak.mises_MPa
            yield LinearLimit(torque, f"the {PART_OF[name]}'s peak stress reaches {words}")


def _limit(design: Design, part: PartName) -> tuple[float, str]:
    stated = design.part(part).material.fatigue_limit_MPa
    if stated is not None and stated <= HIGHEST_STRENGTH_MPA:
        return stated, f"the fatigue limit of {stated:g} MPa"
    highest = f"{HIGHEST_STRENGTH_MPA:g} MPa, above the strength of any metal used in gears"
    return HIGHEST_STRENGTH_MPA, highest


def _nominal_mises(design: Design) -> Iterator[tuple[PartName, str, float]]:
    """Part, place, and von Mises stress √3·τ there per torque [MPa per N·m], by equilibrium alone."""
    f = design.flexspline
    yield "flexspline", "the flexspline's tube", _tube(f.wall_radius, f.inner_radius)
    inside = f.size(f.land_edge) / 2 if f.inward else f.wall_radius
    shear = NMM_PER_NM / (2 * pi * inside**2 * f.diaphragm_thickness_mm)
    yield "flexspline", f"the diaphragm at r = {inside:g} mm", sqrt(3) * shear
    for s in design.shaft.segment:
        outer, inner = s.outer_diameter_mm / 2, s.inner_diameter_mm / 2
        yield "shaft", f"the shaft of {s.outer_diameter_mm:g} mm", _tube(outer, inner)


def _tube(outer: float, inner: float) -> float:
    """Coulomb: τ = T R/J, at the outside."""
    return sqrt(3) * NMM_PER_NM * outer / polar_moment_mm4(outer, inner)
