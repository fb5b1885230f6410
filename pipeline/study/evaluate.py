"""One design of a study: its figures by the fast model, or why there are none.

The fast model (`pipeline.revolved`) leaves bolt holes and keyway out, but for a factor on K_b and K_e where
a study gives one (`pipeline.study.holes`).
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from flexspline.fea.shortfall import settled_peak
from flexspline.fea.types import Stiffness, StressPeak
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError, DesignError
from flexspline.geometry.keys import with_values
from flexspline.geometry.load import design_from
from flexspline.geometry.mass import masses
from flexspline.geometry.part import PartName
from flexspline.pipeline.backlash import StiffnessValueError, backlash, series_stiffness
from flexspline.pipeline.bearing_play import BearingPlayDomainError
from flexspline.pipeline.revolved import (
    contact,
    ellipse_peak,
    lobes,
    revolved,
    torque_peak,
    torsion,
)
from flexspline.pipeline.study.figures import SIZES, Solve
from flexspline.pipeline.study.holes import Holes, with_holes

TORSION_TOLERANCE = 2e-3
LOBE_TOLERANCE = 1e-2
STRESS_TOLERANCE = 1e-2
"""Finer costs more than it tells among designs that differ by percents; bounds are in the row."""

OUR_ERRORS = (DesignError, ComputationError, BearingPlayDomainError, StiffnessValueError)


@dataclass(frozen=True)
class Task:
    """What a worker is asked: tables of the design file, values by dotted key, which solves."""

    tables: Mapping[str, Any]
    values: Mapping[str, float]
    solves: tuple[Solve, ...]
    holes: Holes = field(default_factory=dict)


@dataclass(frozen=True)
class Outcome:
    """Figures by result.json key, or the reason why there are none; seconds of work."""

    figures: Mapping[str, float] = field(default_factory=dict)
    reason: str = ""
    seconds: float = 0.0


def evaluate(task: Task) -> Outcome:
    """Build and solve one design; only our own errors become a reason."""
    began = time.perf_counter()
    try:
        design = with_values(design_from(task.tables), task.values)
        figures = figures_of(design, task.solves, task.holes)
    except OUR_ERRORS as fault:
        return Outcome(reason=str(fault), seconds=time.perf_counter() - began)
    return Outcome(figures, seconds=time.perf_counter() - began)


def figures_of(
    design: Design, solves: tuple[Solve, ...], holes: Holes = MappingProxyType({})
) -> dict[str, float]:
    """All figures that the solves give, and the sizes; K_b and K_e corrected for `holes`.

    Raises
    ------
    DesignError, ComputationError, BearingPlayDomainError
    """
    flexspline, shaft = revolved(design).parts
    found: dict[str, float] = {}
    in_sum = design.solver.K_b_in_sum
    if "lobes" in solves or in_sum != "K_b":
        found |= _stiffness("K_b_lobes", lobes(flexspline, True, LOBE_TOLERANCE))
    if "unsupported" in solves:
        found |= _stiffness("K_b_lobes_unsupported", lobes(flexspline, False, LOBE_TOLERANCE))
    if "contact" in solves:
        found |= _stiffness("K_b_lobes_contact", contact(flexspline, LOBE_TOLERANCE))
    if "ellipse" in solves:
        w0 = design.gear.centre_distance_mm
        found |= _peak("wave_generator_peak", ellipse_peak(flexspline, w0, STRESS_TOLERANCE))
    if "torque" in solves:
        torque = design.load.torque_Nm
        found |= _peak("torque_peak", torque_peak(flexspline, torque, STRESS_TOLERANCE))
        found |= _peak("shaft_torque_peak", torque_peak(shaft, torque, STRESS_TOLERANCE))
    if "torsion" in solves:
        found |= _stiffness("K_b", torsion(flexspline, TORSION_TOLERANCE))
        found |= _stiffness("K_e", torsion(shaft, TORSION_TOLERANCE))
        found = with_holes(found, design, holes)
        found |= _sum(design, found)
    mass = masses(design)
    sizes = (
        mass.flexspline_g, design.flexspline.length_mm, mass.shaft_g, design.shaft.length,
    )  # fmt: skip
    return found | dict(zip(SIZES, sizes, strict=True))


def revolved_torsion(design: Design, name: PartName) -> tuple[float, float, float]:
    """K and its bounds [N·m/rad] of a part without its holes."""
    found = torsion(revolved(design).part(name), TORSION_TOLERANCE)
    return found.K_Nm_per_rad, found.lower_Nm_per_rad, found.upper_Nm_per_rad


def _sum(design: Design, found: Mapping[str, float]) -> dict[str, float]:
    K_b, K_e = found[f"{design.solver.K_b_in_sum}_Nm_per_rad"], found["K_e_Nm_per_rad"]
    total = backlash(design, K_b, K_e)
    terms = ["shaft", "flexspline", "flank_clearance", "bearing_play", "total"]
    terms += ["std"] if total.std_arcsec is not None else []
    return {
        "K_series_Nm_per_rad": series_stiffness(K_b, K_e),
        **{f"backlash_arcsec.{t}": float(getattr(total, f"{t}_arcsec")) for t in terms},
    }


def _peak(name: str, found: StressPeak) -> dict[str, float]:
    """The figure, and 1 where it lies at the border of the excluded zone, else 0."""
    peak = settled_peak(found)
    return {
        f"{name}_mises_MPa": peak.mises_MPa,
        f"{name}_at_excluded_border": float(peak.at_excluded_border),
    }


def _stiffness(name: str, found: Stiffness) -> dict[str, float]:
    bounds = f"{name}_bounds_Nm_per_rad"
    return {
        f"{name}_Nm_per_rad": found.K_Nm_per_rad,
        f"{bounds}[0]": found.lower_Nm_per_rad,
        f"{bounds}[1]": found.upper_Nm_per_rad,
    }
