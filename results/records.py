"""result.json: the contract's keys, and only those that a command computed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from results.atomic import write_bytes

if TYPE_CHECKING:
    from fea.toothed_ring.equivalent import EquivalentRing
    from fea.types import SolidField, Stiffness, StressPeak
    from geometry.design import Design
    from pipeline.backlash import Backlash
    from pipeline.chain import RunResult, Stiffnesses
    from pipeline.diagnosis.extended_backlash import ExtendedBacklash

Record = dict[str, Any]


def program_version() -> str:
    """The installed distribution's version; "unknown" when run from a bare source tree."""
    try:
        return version("flexspline")
    except PackageNotFoundError:
        return "unknown"


def heading(design: Design) -> Record:
    """Which design, which program."""
    return {"design": design.name, "version": program_version()}


def stiffness_record(design: Design, found: Stiffnesses, wall_s: float) -> Record:
    """K of every load case that was solved, with bounds, and how it was solved."""
    record: Record = {}
    for name in ("K_b", "K_b_lobes", "K_b_lobes_contact", "K_b_lobes_unsupported", "K_e"):
        stiffness: Stiffness | None = getattr(found, name)
        if stiffness is not None:
            record[f"{name}_Nm_per_rad"] = stiffness.K_Nm_per_rad
            record[f"{name}_bounds_Nm_per_rad"] = [
                stiffness.lower_Nm_per_rad,
                stiffness.upper_Nm_per_rad,
            ]
    if found.wave_generator_peak is not None:
        record |= _peak("wave_generator_peak", found.wave_generator_peak)
        record["stress_excluded"] = found.wave_generator_peak.excluded
    if found.ring is not None:
        record |= _ring(design, found.ring)
    if found.K_b is not None and found.K_e is not None:
        record["K_series_Nm_per_rad"] = found.series_Nm_per_rad(design)
    solver = {
        name: _solver(k) for name, k in (("flexspline", found.K_b), ("shaft", found.K_e)) if k
    }
    # the contract's flat figures are the flexspline's, or the shaft's where that alone was solved
    record["solver"] = {**next(iter(solver.values())), "wall_s": round(wall_s, 3), "parts": solver}
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
    """The four terms, their sum and its standard deviation."""
    terms = ("shaft", "flexspline", "flank_clearance", "bearing_play", "total", "std")
    record: Record = {
        "backlash_arcsec": {term: getattr(total, f"{term}_arcsec") for term in terms},
        "backlash_std_by_source_arcsec": dict(total.std_by_source_arcsec),
    }
    if total.model_form_arcsec is not None:
        record["backlash_other_play_model_arcsec"] = total.model_form_arcsec
    return record


def stress_record(fields: Mapping[str, SolidField]) -> Record:
    """The peaks under torque."""
    return {
        **_peak("torque_peak", fields["flexspline_torque"].peak),
        **_peak("shaft_torque_peak", fields["shaft_torque"].peak),
    }


def _peak(key: str, peak: StressPeak) -> Record:
    return {f"{key}_mises_MPa": peak.mises_MPa, f"{key}_at_mm": list(peak.at_mm)}


def run_record(result: RunResult, wall_s: float) -> Record:
    """Everything that `flexspline run` found."""
    return {
        **heading(result.design),
        **stiffness_record(result.design, result.stiffnesses, wall_s),
        **stress_record(result.fields),
        **backlash_record(result.backlash),
        "warnings": list(result.warnings),
        "stage_s": {name: round(s, 3) for name, s in result.stage_seconds.items()},
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
    """Text of a record; refuses NaN and infinity, which JSON does not have."""
    return json.dumps(record, indent=2, ensure_ascii=False, allow_nan=False)


def write_record(folder: Path, record: Record) -> None:
    """`result.json` in `folder`, whole or not at all."""
    write_bytes(folder / "result.json", (as_json(record) + "\n").encode())
