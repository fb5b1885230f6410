"""One design of a study: its figures by the fast model, or the reason why there are none.

The fast model (`pipeline.revolved`): K_b of a flexspline with bolt holes is enclosed, K_e of a shaft with
holes corrected where a study gives a factor (`pipeline.study.holes`); stresses leave holes out.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from flexspline.fea.shortfall import settled_peak
from flexspline.fea.types import Stiffness, StressPeak
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.keys import with_values
from flexspline.geometry.load import design_from
from flexspline.geometry.mass import masses
from flexspline.pipeline.backlash import backlash, series_stiffness
from flexspline.pipeline.errors import NestingError
from flexspline.pipeline.gear.gear_chain import fast_chain
from flexspline.pipeline.gear.gear_curve import curve_of
from flexspline.pipeline.load_cases import CASES
from flexspline.pipeline.revolved import stiffness, with_equivalent_ring
from flexspline.pipeline.revolved_stress import ellipse_peak, half_seat_peak, torque_peak
from flexspline.pipeline.rim_case import RIM_CASES, figure_of
from flexspline.pipeline.stress_limits import ON_ELLIPSE, ON_HALF_SEAT
from flexspline.pipeline.study.design_faults import DESIGN_FAULTS
from flexspline.pipeline.study.figures import GIVEN_BY, SIZES, Solve, stiffness_figures
from flexspline.pipeline.study.holes import HolesEffect, pierced, with_holes

STUDY_TORSION_WIDTH = 2e-3
"""Width of the bounds of K over K [1]: the designs of a study differ by percents, and a finer mesh costs
more time than such bounds are worth. They are in the row."""
STUDY_LOBE_WIDTH = 1e-2
"""The same of the load cases with lobes, whose error falls more slowly from mesh to mesh."""
STUDY_STRESS_TOLERANCE = 1e-2
"""Share by which a peak may still change from mesh to mesh [1]; a peak has no bounds."""


@dataclass(frozen=True)
class Task:
    """A worker's task: tables of the design file, values by dotted key, and which solves."""

    tables: Mapping[str, Any]
    values: Mapping[str, float]
    solves: tuple[Solve, ...]
    holes: HolesEffect | None = None


@dataclass(frozen=True)
class Outcome:
    """Figures by result.json key, the faults for which some or all are missing, and seconds of work.

    `contradicted` : whether the fault is a NestingError, so that a model of the program is wrong.
    """

    figures: Mapping[str, float] = field(default_factory=dict)
    faults: tuple[str, ...] = ()
    seconds: float = 0.0
    contradicted: bool = False

    @property
    def reason(self) -> str:
        """All faults in one line; "" where nothing is missing."""
        return "; ".join(self.faults)


def outcome_of(stored: Mapping[str, Any]) -> Outcome:
    """Return an outcome from its `asdict` as JSON, which has no tuples."""
    return Outcome(**{**stored, "faults": tuple(stored["faults"])})


def evaluate(task: Task) -> Outcome:
    """Build and solve one design; only our own errors become a fault of it.

    A NestingError leaves the design without figures: one of two models of it is wrong.
    """
    began = time.perf_counter()
    try:
        design = with_values(design_from(task.tables), task.values)
        outcome = figures_of(design, task.solves, task.holes)
    except DesignError as fault:
        outcome = Outcome(faults=tuple(single.alone for single in (fault, *fault.others)))
    except NestingError as fault:
        outcome = Outcome(faults=(str(fault),), contradicted=True)
    except DESIGN_FAULTS as fault:
        outcome = Outcome(faults=(str(fault),))
    return replace(outcome, seconds=time.perf_counter() - began)


def figures_of(
    design: Design, solves: tuple[Solve, ...], holes: HolesEffect | None = None
) -> Outcome:
    """Return all figures that the solves give, and the sizes; K_e of a shaft with holes times `holes`.

    A solve that fails leaves the others' figures; its fault names it.

    Raises
    ------
    DesignError, ComputationError : the plain ring of drawn teeth does not fit, or was not found.
    NestingError
    """
    flexspline, shaft = with_equivalent_ring(design).parts
    in_sum, w0, torque = (
        design.solver.K_b_in_sum, design.w0_mm, design.load.torque_Nm,
    )  # fmt: skip
    wanted: dict[str, Callable[[], Stiffness | StressPeak]] = {}
    for case in RIM_CASES:
        if case in solves or figure_of(case) == in_sum:
            wanted[figure_of(case)] = partial(CASES[case].fast, flexspline, STUDY_LOBE_WIDTH)
    if "ellipse" in solves:
        wanted[ON_ELLIPSE] = lambda: ellipse_peak(flexspline, w0, STUDY_STRESS_TOLERANCE)
    if "half_seat" in solves:
        wanted[ON_HALF_SEAT] = lambda: half_seat_peak(flexspline, w0, STUDY_STRESS_TOLERANCE)
    if "torque" in solves:
        wanted["torque_peak"] = lambda: torque_peak(flexspline, torque, STUDY_STRESS_TOLERANCE)
        wanted["shaft_torque_peak"] = lambda: torque_peak(shaft, torque, STUDY_STRESS_TOLERANCE)
    if "torsion" in solves:
        wanted["K_b"] = lambda: stiffness(design, "flexspline", STUDY_TORSION_WIDTH)
        wanted["K_e"] = lambda: fast_K_e(design)
    figures: dict[str, float] = {}
    missing: dict[str, str] = {}

    def attempt(name: str, make: Callable[[], Mapping[str, float]]) -> None:
        try:
            figures.update(make())
        except DESIGN_FAULTS as fault:
            missing[name] = str(fault)

    for name, solve in wanted.items():
        attempt(name, partial(_solved, name, solve))
    if "torsion" in solves:
        if holes is not None and "K_e" not in missing and pierced(design):
            figures |= with_holes(figures, design, holes)
        if "gear" in solves and "K_e" not in missing:
            attempt("gear", lambda: _gear(design, figures["K_e_Nm_per_rad"]))
        if not {in_sum, "K_e"} & set(missing):
            attempt("backlash_arcsec", lambda: _sum(design, figures))
    mass = masses(design)
    sizes = (
        mass.flexspline_g, design.flexspline.length_mm, mass.shaft_g, design.shaft.length,
    )  # fmt: skip
    figures |= dict(zip(SIZES, sizes, strict=True))
    return Outcome(figures, tuple(f"{name}: {why}" for name, why in missing.items()))


def fast_K_e(design: Design) -> Stiffness:
    """Return K_e of the shaft without its holes; errors as `pipeline.revolved.stiffness`."""
    return stiffness(design, "shaft", STUDY_TORSION_WIDTH)


def _sum(design: Design, figures: Mapping[str, float]) -> dict[str, float]:
    K_b, K_e = figures[f"{design.solver.K_b_in_sum}_Nm_per_rad"], figures["K_e_Nm_per_rad"]
    total = backlash(design, K_b, K_e)
    sums = {**total.terms_arcsec, "total": total.total_arcsec}
    if total.std_arcsec is not None:
        sums["std"] = total.std_arcsec
    return {
        "K_series_Nm_per_rad": series_stiffness(K_b, K_e),
        **{f"backlash_arcsec.{name}": float(value) for name, value in sums.items()},
    }


def _gear(design: Design, K_e_Nm_per_rad: float) -> dict[str, float]:
    curve = curve_of(design, fast_chain(design, K_e_Nm_per_rad, STUDY_TORSION_WIDTH))
    return {key: float(getattr(curve, key)) for key in GIVEN_BY["gear"]}


def _solved(name: str, solve: Callable[[], Stiffness | StressPeak]) -> dict[str, float]:
    """A stiffness, its bounds, and 1 where these are theorems, else 0; or a peak, and 1 where it lies at
    the excluded border, else 0."""
    solved = solve()
    if isinstance(solved, StressPeak):
        peak = settled_peak(solved)
        return {
            f"{name}_mises_MPa": peak.mises_MPa,
            f"{name}_at_excluded_border": float(peak.at_excluded_border),
        }
    guaranteed = {f"{name}_bounds_guaranteed": float(solved.guaranteed)}
    return stiffness_figures(name, solved) | guaranteed
