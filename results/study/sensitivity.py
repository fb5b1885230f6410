"""`flexspline sensitivity`: the table for people, sensitivity.json for machines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexspline.geometry.design import Design
from flexspline.pipeline.first_face import too_large_lines
from flexspline.pipeline.study.clearance_slopes import ClearanceSlope, clearance_slopes
from flexspline.pipeline.study.slope import Slope
from flexspline.results.records import heading

K_OF = {"flexspline": "K_b_Nm_per_rad", "shaft": "K_e_Nm_per_rad"}


def record(design: Design, slopes: Sequence[Slope]) -> dict[str, Any]:
    """What sensitivity.json holds; a way that gave nothing is absent."""
    return {
        **heading(design),
        "sensitivity": [_entry(s) for s in slopes],
        "clearances": [_clearance(c) for c in clearance_slopes(design)],
        "warnings": list(too_large_lines(design)),
    }


def _clearance(c: ClearanceSlope) -> dict[str, Any]:
    return {
        "key": c.key,
        "value_um": c.value_um,
        "backlash_arcsec": c.arcsec,
        "backlash_arcsec_per_um": c.arcsec_per_um,
    }


def _entry(s: Slope) -> dict[str, Any]:
    entry: dict[str, Any] = {"key": s.key, "value_mm": s.value_mm, "figure": K_OF[s.part]}
    if s.held is not None:
        entry["adjoint_Nm_per_rad_per_mm"] = s.held
    if s.solved is not None:
        entry["difference_Nm_per_rad_per_mm"] = s.solved
        entry["difference_error_Nm_per_rad_per_mm"] = s.solved_error
    if s.agree is not None:
        entry["agree"] = s.agree
    if s.why:
        entry["one_way_because"] = s.why.words
    entry["pct_per_pct"] = s.elasticity
    if s.backlash_arcsec_per_mm is not None:
        entry["backlash_arcsec_per_mm"] = s.backlash_arcsec_per_mm
    if s.why_no_sum:
        entry["no_backlash_because"] = s.why_no_sum.words
    return entry


def lines(design: Design, slopes: Sequence[Slope]) -> list[str]:
    """A table of the dimensions, both ways side by side, and a word where they do not meet; one of the
    clearances."""
    out = [
        f"{'dimension':42} {'mm':>8} {'dK/dp, adjoint':>16} {'by differences':>24} {'%/%':>7} "
        f"{'arcsec/mm':>10}"
    ]
    for s in slopes:
        held = "-" if s.held is None else f"{s.held:.1f}"
        solved = "-" if s.solved is None else f"{s.solved:.1f} ± {s.solved_error:.1f}"
        of_sum = "-" if s.backlash_arcsec_per_mm is None else f"{s.backlash_arcsec_per_mm:.3f}"
        word = {True: "", False: "  DISAGREE", None: f"  one method only: {s.why}"}[s.agree]
        if s.why_no_sum:
            word += f"  effect on the backlash sum not given: {s.why_no_sum}"
        out.append(
            f"{s.key:42} {s.value_mm:8.4g} {held:>16} {solved:>24} {s.elasticity:7.3f} "
            f"{of_sum:>10}{word}"
        )
    out.append(
        "dK/dp in N·m/rad per mm: of K_b by keys of the flexspline, of K_e by keys of the shaft, both "
        f'without bolt holes and keyway, load case "uniform"; arcsec/mm of the sum, load case '
        f'"{design.solver.load_case}"'
    )
    if design.flexspline.teeth != "none":
        out.append(
            "flexspline.ring_thickness_mm is here the thickness of the plain ring that replaces the drawn "
            f"teeth, not the file's {design.flexspline.ring_thickness_mm:g} mm"
        )
    out.append(f"{'clearance':42} {'µm':>8} {'in the sum, arcsec':>20} {'arcsec/µm':>11}")
    out += [
        f"{c.key:42} {c.value_um:8.4g} {c.arcsec:20.1f} {c.arcsec_per_um:11.3f}"
        for c in clearance_slopes(design)
    ]
    return out
