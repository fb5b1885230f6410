"""result.json: the keys of docs/contract.md, and only those that a command computed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from flexspline import __version__
from flexspline.geometry.errors import readable
from flexspline.geometry.mass import masses
from flexspline.geometry.sanity import warnings
from flexspline.pipeline.stress_limits import ON_HALF_SEAT, PEAK_OF
from flexspline.results.gear_quantities import GEAR_QUANTITIES
from flexspline.results.gear_words import gear_notes, gear_warnings
from flexspline.results.limit_words import reason
from flexspline.results.peaks import WITHOUT_HOLES
from flexspline.results.quantities import bounds_kind
from flexspline.results.warned import all_warnings, shortfalls

if TYPE_CHECKING:
    from flexspline.fea.toothed_ring.equivalent import EquivalentRing
    from flexspline.fea.types import SolidField, Stiffness, StressPeak
    from flexspline.geometry.design import Design
    from flexspline.pipeline.analysis import RunResult
    from flexspline.pipeline.backlash import Backlash
    from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash
    from flexspline.pipeline.gear.gear_curve import GearCurve
    from flexspline.pipeline.linear_limit import LinearLimit
    from flexspline.pipeline.stiffnesses import Stiffnesses

Record = dict[str, Any]


def heading(design: Design) -> Record:
    """Which design, which program."""
    return {"design": design.name, "version": __version__}


def stiffness_record(design: Design, stiffnesses: Stiffnesses, wall_s: float) -> Record:
    """K of every load case that was solved, with bounds, and how it was solved."""
    record: Record = {}
    for name, stiffness in stiffnesses.solved.items():
        record |= bounded_record(name, stiffness)
    if stiffnesses.wave_generator_peak is not None:
        record |= peak_record("wave_generator_peak", stiffnesses.wave_generator_peak)
        record["stress_excluded"] = stiffnesses.wave_generator_peak.excluded
    if stiffnesses.half_seat_peak is not None:
        record["wave_generator_seat_width_mm"] = design.flexspline.ring_width_mm
        record |= peak_record(ON_HALF_SEAT, stiffnesses.half_seat_peak)
    if stiffnesses.full_seat_peak is not None:
        record[WITHOUT_HOLES] = stiffnesses.full_seat_peak.mises_MPa
    if stiffnesses.ring is not None:
        record |= _ring(design, stiffnesses.ring)
    if stiffnesses.has_sum(design):
        record["K_series_Nm_per_rad"] = stiffnesses.series_Nm_per_rad(design)
    solver = {
        part: _solver(stiffnesses[K])
        for part, K in (("flexspline", "K_b"), ("shaft", "K_e"))
        if K in stiffnesses.solved
    }
    # these flat figures are the flexspline's, or the shaft's where that alone was solved
    flat = next(iter(solver.values()), {})
    record["solver"] = {**flat, "wall_s": round(wall_s, 3), "parts": solver}
    record["warnings"] = [*warnings(design), *shortfalls(design, stiffnesses)]
    return record


def bounded_record(name: str, stiffness: Stiffness) -> Record:
    """One stiffness, its bounds, and what they are; those that are theorems too, where they are wider."""
    record: Record = {
        f"{name}_Nm_per_rad": stiffness.K_Nm_per_rad,
        f"{name}_bounds_Nm_per_rad": list(stiffness.bounds_Nm_per_rad),
        f"{name}_bounds_kind": bounds_kind(stiffness.guaranteed),
    }
    if stiffness.proven_Nm_per_rad is not None:
        record[f"{name}_guaranteed_bounds_Nm_per_rad"] = list(stiffness.proven_Nm_per_rad)
        record[f"{name}_guaranteed_bounds_kind"] = bounds_kind(True)
    return record


def _ring(design: Design, ring: EquivalentRing) -> Record:
    """The rim as designed and the plain rings as stiff as it is with its teeth."""
    return {
        "ring_thickness_mm": design.flexspline.ring_thickness_mm,
        "equivalent_ring_thickness_mm": ring.bending_mm,
        "equivalent_ring_thickness_membrane_mm": ring.membrane_mm,
        "equivalent_ring_thickness_torsion_mm": ring.torsion_mm,
        "equivalent_ring_difference_pct": ring.difference_pct,
    }


def _solver(stiffness: Stiffness) -> Record:
    finest = stiffness.levels[-1]
    return {
        "model": stiffness.model,
        "elements": finest.elements,
        "dofs": finest.dofs,
        "symmetry": stiffness.symmetry,
        "method": stiffness.method,
    }


def backlash_record(total: Backlash) -> Record:
    """The four terms, their sum, and its standard deviation where the design states one."""
    sums = {**total.terms_arcsec, "total": total.total_arcsec}
    record: Record = {"backlash_arcsec": sums}
    if total.std_arcsec is not None:
        sums["std"] = total.std_arcsec
        record["backlash_std_by_source_arcsec"] = dict(total.std_by_source_arcsec)
    if total.model_form_arcsec is not None:
        record["backlash_other_play_model_arcsec"] = total.model_form_arcsec
    return record


def stress_record(fields: Mapping[str, SolidField]) -> Record:
    """The peaks under torque, of the fields that there are."""
    record: Record = {}
    for name in ("flexspline_torque", "shaft_torque"):
        if name in fields:
            record |= peak_record(PEAK_OF[name], fields[name].peak)
    return record


def peak_record(name: str, peak: StressPeak) -> Record:
    """A peak stress, its place, and whether it is the part's or hangs on how far edges are left out."""
    record: Record = {
        f"{name}_mises_MPa": peak.mises_MPa,
        f"{name}_at_mm": list(peak.at_mm),
        f"{name}_at_excluded_border": peak.at_excluded_border,
        f"{name}_excluded_mm": peak.exclusion_mm,
    }
    if peak.mises_at_twice_MPa is not None:
        record[f"{name}_mises_at_twice_excluded_MPa"] = peak.mises_at_twice_MPa
    return record


def linear_limit_record(limit: LinearLimit) -> Record:
    """Beyond which torque the linear model is not valid."""
    return {"linear_torque_limit_Nm": limit.torque_Nm, "linear_torque_limit_reason": reason(limit)}


def mass_record(design: Design) -> Record:
    """What both parts weigh, without teeth."""
    mass = masses(design)
    return {"flexspline_mass_g": mass.flexspline_g, "shaft_mass_g": mass.shaft_g}


def run_record(result: RunResult, wall_s: float) -> Record:
    """Everything that `flexspline run` found."""
    return {
        **heading(result.design),
        **stiffness_record(result.design, result.stiffnesses, wall_s),
        **stress_record(result.fields),
        **mass_record(result.design),
        **backlash_record(result.backlash),
        **linear_limit_record(result.linear_limit),
        **({} if result.gear is None else {"gear": gear_figures(result.gear)}),
        "warnings": list(all_warnings(result)),
        "stage_s": {name: round(s, 3) for name, s in result.stage_seconds.items()},
    }


GEAR_FIGURES = (*(q.key for q in GEAR_QUANTITIES if "." not in q.key), "terms_torque_Nm")
"""Of the record, by their names in `GearCurve`."""


def gear_figures(curve: GearCurve) -> Record:
    """The whole gear; no friction is modelled, so there is no hysteresis loss."""
    return {
        **{key: v for key in GEAR_FIGURES if (v := getattr(curve, key)) is not None},
        "compliance_shares": dict(curve.compliance_shares),
        "terms_arcsec": dict(curve.terms_arcsec),
        "assumed": [{"key": a.key, "value": a.value, "why": a.why} for a in curve.assumed],
        "notes": gear_notes(curve),
        "warnings": gear_warnings(curve),
    }


def extended_record(extended: ExtendedBacklash, model: str) -> Record:
    """What an extended model adds to the backlash; `model` is its file's name."""
    return {
        "extended": {
            "model": model,
            "calibration_arcsec": extended.calibration_arcsec,
            "causes_arcsec": dict(extended.causes_arcsec),
            "total_arcsec": extended.total_arcsec,
        }
    }


def as_json(record: Record) -> str:
    """Text of a record; refuses NaN and infinity, which JSON does not have.

    Names of files are written as UTF-8 has them, whatever the locale.
    """
    return readable(json.dumps(record, indent=2, ensure_ascii=False, allow_nan=False))
