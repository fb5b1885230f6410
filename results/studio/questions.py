"""Questions about a design that a worker answers, by name; they run in the worker's process."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.types import Stiffness
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError, DesignError
from flexspline.geometry.load import design_from
from flexspline.pipeline.errors import NestingError
from flexspline.pipeline.fast_model import (
    field,
    first_field,
    first_lobes,
    gear,
    profile,
    rim,
    torsion,
)
from flexspline.pipeline.revolved import revolved
from flexspline.pipeline.rim_case import RIM_CASES, RimCase, figure_of
from flexspline.pipeline.stress_limits import PEAK_OF, STRESS_CASES, StressCase
from flexspline.results.records import bounded_record, gear_figures, peak_record
from flexspline.results.studio.shape import field_message, profile_message
from flexspline.results.studio.worker import Fault

RIM: Mapping[str, RimCase] = {figure_of(case): case for case in RIM_CASES}
"""The load cases of the rim by the figure that each answers with."""
FIRST_STRESS = "first field wave_generator"
"""The stress on the wave generator before any refinement; its `PEAK_rough` says so."""
FIRST_LOBES = "first K_b_lobes"
"""K_b at the lobes before any refinement; its `_rough` says so."""
GEAR = "gear"
"""The whole gear's figures and the positive branch of its curve."""
CHORDS_PER_WALL = 40
"""Arcs of a shape without stress are drawn with chords no farther off than wall/40."""

Answer = dict[str, Any]
"""Figures by result.json key; "picture" holds bytes for the tab."""


def answer(question: str, tables: Mapping[str, Any]) -> Answer | Fault:
    """The figures, or why there are none; only our own errors become a Fault."""
    try:
        return _QUESTIONS[question](design_from(tables))
    except DesignError as fault:
        return Fault(fault.key, str(fault))
    except (ComputationError, NestingError) as fault:
        return Fault("", str(fault))


def _torsion(design: Design) -> Answer:
    K_b, K_e = torsion(design)
    return bounded_record("K_b", K_b) | bounded_record("K_e", K_e)


def _rim(name: str, design: Design) -> Answer:
    return _bounded(name, rim(design, RIM[name]), rough=False)


def _bounded(name: str, stiffness: Stiffness, rough: bool) -> Answer:
    return bounded_record(name, stiffness) | {f"{name}_rough": rough}


def _gear(design: Design) -> Answer:
    curve = gear(design)
    up = curve.torque_Nm.index(max(curve.torque_Nm)) + 1  # the other branches mirror the first
    line = {"torque_Nm": curve.torque_Nm[:up], "angle_arcsec": curve.angle_arcsec[:up]}
    return {"gear": {**gear_figures(curve), "line": line}}


def _field(view: StressCase, design: Design) -> Answer:
    return _solved(view, field(revolved(design), view), rough=False)


def _first(design: Design) -> Answer:
    return _solved("wave_generator", first_field(revolved(design)), rough=True)


def _solved(view: StressCase, solved: RevolvedField, rough: bool) -> Answer:
    name = PEAK_OF[view]
    return {
        **peak_record(name, solved.peak),
        f"{name}_rough": rough,
        "picture": field_message(view, solved),
    }


def _profile(view: StressCase, design: Design) -> Answer:
    chord = design.flexspline.wall_thickness_mm / CHORDS_PER_WALL
    return {"picture": profile_message(view, profile(revolved(design), view, chord))}


_QUESTIONS: dict[str, Callable[[Design], Answer]] = {
    "torsion": _torsion,
    GEAR: _gear,
    FIRST_STRESS: _first,
    FIRST_LOBES: lambda design: _bounded("K_b_lobes", first_lobes(design), rough=True),
    **{name: partial(_rim, name) for name in RIM},
    **{f"field {view}": partial(_field, view) for view in STRESS_CASES},
    **{f"profile {view}": partial(_profile, view) for view in STRESS_CASES},
}
