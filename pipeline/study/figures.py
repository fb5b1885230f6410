"""Figures that a study can use, by their keys in result.json, and the solve that gives each of them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from flexspline.fea.types import Stiffness
from flexspline.geometry.near_key import nearest_key
from flexspline.pipeline.backlash import TERMS
from flexspline.pipeline.rim_case import RIM_CASES, RimCase, figure_of
from flexspline.pipeline.stress_limits import ON_ELLIPSE, ON_HALF_SEAT

Solve = Literal["torsion", "ellipse", "half_seat", "torque", "gear"] | RimCase


def stiffness_keys(name: str) -> tuple[str, str, str]:
    """Return the keys of a stiffness and both its bounds, by its name, such as "K_b"."""
    bounds = f"{name}_bounds_Nm_per_rad"
    return f"{name}_Nm_per_rad", f"{bounds}[0]", f"{bounds}[1]"


def stiffness_figures(name: str, K: Stiffness) -> dict[str, float]:
    """Return a stiffness and both its bounds, by their keys."""
    values = K.K_Nm_per_rad, *K.bounds_Nm_per_rad
    return dict(zip(stiffness_keys(name), values, strict=True))


GIVEN_BY: dict[Solve, tuple[str, ...]] = {
    "torsion": (
        *stiffness_keys("K_b"),
        *stiffness_keys("K_e"),
        "K_series_Nm_per_rad",
        *(f"backlash_arcsec.{name}" for name in (*TERMS, "total", "std")),
    ),
    **{case: stiffness_keys(figure_of(case)) for case in RIM_CASES},
    "ellipse": (f"{ON_ELLIPSE}_mises_MPa",),
    "half_seat": (f"{ON_HALF_SEAT}_mises_MPa",),
    "torque": ("torque_peak_mises_MPa", "shaft_torque_peak_mises_MPa"),
    "gear": (
        "K1_Nm_per_rad",
        "K2_Nm_per_rad",
        "K3_Nm_per_rad",
        "lost_motion_arcsec",
        "teeth_in_contact",
        "preload_tooth_force_N",
    ),
}
SIZES = ("flexspline_mass_g", "flexspline_length_mm", "shaft_mass_g", "shaft_length_mm")
"""Need no solve."""
FIGURES: tuple[str, ...] = (*(k for keys in GIVEN_BY.values() for k in keys), *SIZES)
USUAL_SOLVES: tuple[Solve, ...] = ("torsion", "lobes", "ellipse")
"""Solved for every design of a grid, sobol or optimize study, asked for or not."""
TOTAL = "backlash_arcsec.total"
USUAL_FIGURES = ("K_b_Nm_per_rad", "wave_generator_peak_mises_MPa", TOTAL)
"""What a study without objective and constraint looks at."""


def needed(figures: Iterable[str], usual: tuple[Solve, ...]) -> tuple[Solve, ...]:
    """Return the solves that give the figures asked for, beside the usual ones."""
    wanted = set(figures)
    return tuple(s for s, keys in GIVEN_BY.items() if s in usual or wanted & set(keys))


def not_a_figure(key: str) -> str:
    """Return why a key is refused: the nearest known one, or all of them."""
    begins = [figure for figure in FIGURES if key and figure.startswith(key)]
    if near := begins[0] if begins else nearest_key(key, FIGURES):
        return f"unknown figure; did you mean {near}?"
    return f"unknown figure; a study computes {', '.join(FIGURES)}"
