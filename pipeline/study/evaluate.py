"""One design of a study: its figures by the fast model, or why there are none.

The fast model is the axisymmetric one of the same meridian: bolt holes and keyway are left out, but for a
factor on K_b and K_e where a study gives one (`pipeline.study.holes`). K is
proportional to Young's modulus, so parts are solved for 1 GPa and kept: a design that differs in a
clearance, the torque or the modulus costs nothing.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from types import MappingProxyType
from typing import Any

from flexspline.fea.axisymmetric.contact import contact_stiffness
from flexspline.fea.axisymmetric.lobes import lobe_stiffness
from flexspline.fea.axisymmetric.stress import ellipse_stress, torsion_stress
from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.shortfall import settled_peak
from flexspline.fea.types import Elastic, Stiffness, StressPeak
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError, DesignError
from flexspline.geometry.keys import with_values, without_holes
from flexspline.geometry.load import design_from
from flexspline.geometry.mass import masses
from flexspline.geometry.material import Material
from flexspline.geometry.part import Part, PartName
from flexspline.geometry.shapes import Cup, Hat, Shaft
from flexspline.pipeline.backlash import StiffnessValueError, backlash
from flexspline.pipeline.bearing_play import BearingPlayDomainError
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.storage import cache_folder
from flexspline.pipeline.study.figures import SIZES, Solve
from flexspline.pipeline.study.holes import Holes, with_holes

TORSION_TOLERANCE = 2e-3
LOBE_TOLERANCE = 1e-2
STRESS_TOLERANCE = 1e-2
"""Finer costs more than it tells among designs that differ by percents; bounds are in the row."""
KEPT = 512
"""Solved parts that a worker remembers."""

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
    plain = without_holes(with_equivalent_ring(design))
    f = plain.flexspline
    own, nu = plain.material.flexspline, plain.material.flexspline.poissons_ratio
    E = own.youngs_modulus_GPa
    found: dict[str, float] = {}
    lobed = design.solver.load_case == "lobes"
    if "lobes" in solves or lobed:
        found |= _stiffness("K_b_lobes", _lobes(f, nu, True), E)
    if "unsupported" in solves:
        found |= _stiffness("K_b_lobes_unsupported", _lobes(f, nu, False), E)
    if "contact" in solves:
        found |= _stiffness("K_b_lobes_contact", _contact(f, nu), E)
    if "ellipse" in solves:
        w0 = plain.gear.centre_distance_mm
        found |= _peak("wave_generator_peak", _ellipse(f, nu).times(w0 * E))
    if "torque" in solves:
        torque, shaft_nu = design.load.torque_Nm, plain.part("shaft").material.poissons_ratio
        found |= _peak("torque_peak", _twisted(f, nu).times(torque))
        found |= _peak("shaft_torque_peak", _twisted(plain.shaft, shaft_nu).times(torque))
    if "torsion" in solves:
        shaft = plain.part("shaft").material
        found |= _stiffness("K_b", _torsion(f, nu), E)
        found |= _stiffness(
            "K_e", _torsion(plain.shaft, shaft.poissons_ratio), shaft.youngs_modulus_GPa
        )
        found = with_holes(found, design, holes)
        found |= _sum(design, found["K_b_lobes_Nm_per_rad" if lobed else "K_b_Nm_per_rad"], found)
    mass = masses(design)
    sizes = (
        mass.flexspline_g, design.flexspline.length_mm, mass.shaft_g, design.shaft.length,
    )  # fmt: skip
    return found | dict(zip(SIZES, sizes, strict=True))


def revolved_torsion(design: Design, name: PartName) -> tuple[float, float, float]:
    """K and its bounds [N·m/rad] of a part without its holes."""
    plain = without_holes(with_equivalent_ring(design))
    part = plain.part(name)
    E, nu = part.material.youngs_modulus_GPa, part.material.poissons_ratio
    K, low, high = (k * E for k in _torsion(part.shape, nu))
    return K, low, high


def _sum(design: Design, K_b: float, found: Mapping[str, float]) -> dict[str, float]:
    K_e = found["K_e_Nm_per_rad"]
    total = backlash(design, K_b, K_e)
    terms = ["shaft", "flexspline", "flank_clearance", "bearing_play", "total"]
    terms += ["std"] if total.std_arcsec is not None else []
    return {
        "K_series_Nm_per_rad": 1 / (1 / K_e + 1 / K_b),
        **{f"backlash_arcsec.{t}": float(getattr(total, f"{t}_arcsec")) for t in terms},
    }


def with_equivalent_ring(design: Design) -> Design:
    """With the plain ring that stands for drawn teeth, as in an analysis."""
    if design.flexspline.teeth == "none":
        return design
    context = AnalysisContext(design, Cache(cache_folder(), _ring_types(), _silent), Progress())
    return context.part("flexspline").context.design


def _ring_types() -> tuple[type, ...]:
    from flexspline.pipeline.analysis import CACHED_TYPES

    return CACHED_TYPES


def _peak(name: str, peak: StressPeak) -> dict[str, float]:
    """The figure, and 1 where it lies at the border of the excluded zone, else 0."""
    return {
        f"{name}_mises_MPa": peak.mises_MPa,
        f"{name}_at_excluded_border": float(peak.at_excluded_border),
    }


def _silent(line: str) -> None:
    """A worker's notices go nowhere; what matters comes back as an error."""


def _stiffness(name: str, of_1_GPa: tuple[float, float, float], E_GPa: float) -> dict[str, float]:
    K, low, high = (k * E_GPa for k in of_1_GPa)
    bounds = f"{name}_bounds_Nm_per_rad"
    return {f"{name}_Nm_per_rad": K, f"{bounds}[0]": low, f"{bounds}[1]": high}


Shape = Cup | Hat | Shaft


def of_1_GPa(shape: Shape, nu: float) -> Part:
    """A part of that shape and Poisson's ratio."""
    return Part(shape, Material(name="1 GPa", youngs_modulus_GPa=1.0, poissons_ratio=nu))


def _remembered(solve: Callable[..., Any]) -> Callable[..., Any]:
    return lru_cache(maxsize=KEPT)(solve)


@_remembered
def _torsion(shape: Shape, nu: float) -> tuple[float, float, float]:
    part = of_1_GPa(shape, nu)
    found = torsional_stiffness(
        part.meridian, Elastic.of(part.material), part.driven, TORSION_TOLERANCE
    )
    return found.K_Nm_per_rad, found.lower_Nm_per_rad, found.upper_Nm_per_rad


@_remembered
def _lobe_stiffness(shape: Shape, nu: float, supported: bool) -> Stiffness:
    part = of_1_GPa(shape, nu)
    return lobe_stiffness(part.meridian, Elastic.of(part.material), supported, LOBE_TOLERANCE)


def _lobes(shape: Shape, nu: float, supported: bool) -> tuple[float, float, float]:
    found = _lobe_stiffness(shape, nu, supported)
    return found.K_Nm_per_rad, found.lower_Nm_per_rad, found.upper_Nm_per_rad


@_remembered
def _contact(shape: Shape, nu: float) -> tuple[float, float, float]:
    part = of_1_GPa(shape, nu)
    held = _lobe_stiffness(shape, nu, True)
    found = contact_stiffness(part.meridian, Elastic.of(part.material), held)
    return found.K_Nm_per_rad, found.lower_Nm_per_rad, found.upper_Nm_per_rad


@_remembered
def _ellipse(shape: Shape, nu: float) -> StressPeak:
    """Per mm of w0 and GPa of E."""
    part = of_1_GPa(shape, nu)
    material, apart = Elastic.of(part.material), part.exclusion_mm
    found = ellipse_stress(part.meridian, material, 1.0, apart, STRESS_TOLERANCE)
    return settled_peak(found.peak)


@_remembered
def _twisted(shape: Shape, nu: float) -> StressPeak:
    """Per N·m."""
    part = of_1_GPa(shape, nu)
    material, apart = Elastic.of(part.material), part.exclusion_mm
    found = torsion_stress(part.meridian, material, part.driven, 1.0, apart, STRESS_TOLERANCE)
    return settled_peak(found.peak)
