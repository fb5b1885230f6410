"""What the right side of the page shows: figures with units as the report prints them, and chart data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from flexspline.geometry.design import Design
from flexspline.geometry.listed import joined
from flexspline.geometry.sanity import warnings
from flexspline.pipeline.backlash import (
    ARCSEC_PER_RAD,
    Backlash,
    angle_rad,
    backlash,
    series_stiffness,
)
from flexspline.pipeline.first_face import held_beyond_flange, too_large_line
from flexspline.pipeline.linear_limit import linear_limit
from flexspline.pipeline.stiffnesses import FIGURES
from flexspline.pipeline.stress_limits import PART_OF, limits_passed, share_of_limit
from flexspline.pipeline.study.figures import GIVEN_BY
from flexspline.results.doubt import NOT_STATED, SOURCES, spread_text
from flexspline.results.figures.torque_angle import DRAWN_RATIO, band
from flexspline.results.limit_words import load_beyond
from flexspline.results.numbers import figures_text
from flexspline.results.peaks import (
    BORDER,
    WITHOUT_HOLES,
    at_border,
    half_seat_words,
    marked,
    tabled_peak,
)
from flexspline.results.quantities import bounds_kind, quantities_of, quantity
from flexspline.results.records import backlash_record
from flexspline.results.style import PALETTE

STIFFNESSES = (*FIGURES, "K_series")
PEAKS = tuple(PART_OF)
GEAR_ROWS = tuple(key for key in GIVEN_BY["gear"] if quantity(key).group == "gear")
"""What the fast model gives of the whole gear."""
LINE_POINTS = 25
"""Of the torque–angle line: it is straight, its band bends."""
ESTIMATED = "≈\u2009"
"""Before bounds that are no theorems."""
ComputedFigures = Mapping[str, Any]
Message = dict[str, Any]


def message(design: Design, computed: ComputedFigures) -> Message:
    """All that can be said with the figures found so far; `computed` by result.json key.

    Raises
    ------
    BearingPlayDomainError : bearing play beyond c_max (involute model).
    """
    figures = dict(computed)
    shown: Message = {}
    K_b = computed.get(f"{design.solver.K_b_in_sum}_Nm_per_rad")
    K_e = computed.get("K_e_Nm_per_rad")
    if K_b is not None and K_e is not None:
        figures["K_series_Nm_per_rad"] = series_stiffness(K_b, K_e)
        total = backlash(design, K_b, K_e)
        figures |= backlash_record(total)
        limit = linear_limit(design, figures["K_series_Nm_per_rad"])
        shown = {
            "budget": _budget(total),
            "line": _line(design, total, K_b, K_e),
            "beyond": list(load_beyond(limit, design)),
        }
    if "gear" in computed:
        shown["gear"] = _gear(computed["gear"])
    return {
        "stiffness": [_stiffness(name, figures, design) for name in STIFFNESSES],
        "peaks": [_peak(name, figures, design) for name in PEAKS],
        "w0_mm": design.w0_mm,
        **shown,
    }


def left_out(design: Design) -> tuple[str, ...]:
    """What the fast model does not see, in words; empty for bodies of revolution."""
    omitted = []
    for part in design.parts:
        if part.bolts:
            known = " (K_b's bounds hold with them)" if part.name == "flexspline" else ""
            omitted.append(f"{part.bolts.count} bolt holes of the {part.name}{known}")
    if design.part("shaft").keyway is not None:
        omitted.append("the keyway")
    return tuple(omitted)


def agreement(design: Design) -> str:
    """How these figures stand to those of the command line."""
    both = "; in both, K_e is too large (see the warnings)" if held_beyond_flange(design) else ""
    left = left_out(design)
    if left:
        words = ("keyway" if "keyway" in part else "holes" for part in left)
        but_for = joined(dict.fromkeys(words), "and")
        return f"Equals `flexspline stiffness` except for {but_for}; K_b within its bounds{both}"
    if design.solver.model == "solid":
        return f"Equals `flexspline stiffness` (solid model) within the bounds{both}"
    return f"Equals `flexspline stiffness` to seven digits{both}"


def design_warnings_shown(design: Design) -> list[str]:
    """The design's own, and that K_e is too large; without a solve, as a slider may move."""
    lines = list(warnings(design))
    if held_beyond_flange(design):
        lines.append(too_large_line(design, estimate=False))
    return lines


def figure(key: str, value: float) -> Message:
    """A number and how it is printed; `decimals` serves differences of the same figure."""
    text = quantity(key).text(value)
    return _waiting(key) | {"value": value, "text": text, "decimals": len(text.partition(".")[2])}


def without(name: str, design: Design) -> str:
    """What a figure of the fast model leaves out or holds too much, in a few words; K_b has bounds that hold
    with its holes."""
    shaft = design.part("shaft")
    if name != "K_e":
        return ""
    left = [
        word for word, is_there in (("holes", shaft.bolts), ("keyway", shaft.keyway)) if is_there
    ]
    remarks = [f"without {joined(left, 'and')}"] if left else []
    if held_beyond_flange(design):
        remarks.append("too large")
    return ", ".join(remarks)


def _stiffness(name: str, figures: ComputedFigures, design: Design) -> Message:
    key, bounds = f"{name}_Nm_per_rad", f"{name}_bounds_Nm_per_rad"
    if key not in figures:
        return _waiting(key)
    row = figure(key, figures[key])
    row["rough"] = bool(figures.get(f"{name}_rough"))
    if "solver" not in figures:  # which the record of a finished job has: the fast model's alone
        row["without"] = without(name, design)
    if bounds in figures:
        low, high = figures[bounds]
        half = 50 * (high - low) / figures[key]
        kind = figures[f"{name}_bounds_kind"]
        row |= {
            "bounds": f"{ESTIMATED if kind == bounds_kind(False) else ''}"
            f"{quantity(bounds).range_text(low, high)}",
            "half_pct": f"± {half:.2g} %, {kind}",
        }
    return row


def _peak(name: str, figures: ComputedFigures, design: Design) -> Message:
    key = f"{name}_mises_MPa"
    if key not in figures:
        return _waiting(key)
    r, z = float(np.hypot(*figures[f"{name}_at_mm"][:2])), figures[f"{name}_at_mm"][2]
    row = figure(key, figures[key]) | {"at": f"at r = {r:.2f}, z = {z:.2f} mm"}
    row["rough"] = bool(figures.get(f"{name}_rough"))
    peak = tabled_peak(name, figures)
    if mark := marked(figures, key):
        row |= {"more": mark, "limit": BORDER}
    share = share_of_limit(peak, design.part(PART_OF[name]).material)
    if share is not None:
        limit = design.part(PART_OF[name]).material.fatigue_limit_MPa
        row["limit"] = f"{100 * share:.3g} % of {limit:g}"
    row["over"] = any(limits_passed(design, {name: peak}))
    half = f"{name}_half_seat_mises_MPa"
    if half in figures:
        border, whole = at_border(half, figures), figures.get(WITHOUT_HOLES)
        narrow = half_seat_words(figures[half], border, whole, "on")
        row["more"] = "; ".join(filter(None, [row.get("more"), narrow]))
    return row


def _gear(gear: ComputedFigures) -> Message:
    """Figures, shares of the compliance, assumed keys of the design file; of the fast model the curve too."""
    shares = gear["compliance_shares"].items()
    return {
        "rows": [figure(key, gear[key]) for key in GEAR_ROWS],
        "shares": [
            {"name": name, "value": value, "colour": colour}
            for (name, value), colour in zip(shares, PALETTE, strict=False)
        ],
        "marks": [[mark.symbol, gear[mark.key]] for mark in quantities_of("gear torque")],
        "assumed": [f"{a['key']} = {a['value']:.4g}" for a in gear["assumed"] if "." in a["key"]],
        "warnings": gear["warnings"],
        "line": gear.get("line"),
    }


def _waiting(key: str) -> Message:
    """A figure that is still to come."""
    entry = quantity(key)
    return {
        "key": key, "symbol": entry.symbol, "name": entry.name, "short": entry.short_name,
        "unit": entry.unit,
    }  # fmt: skip


def _budget(total: Backlash) -> Message:
    values = backlash_record(total)["backlash_arcsec"]
    rows = [figure(f"backlash_arcsec.{term}", value) for term, value in values.items()]
    for row, colour in zip(rows, PALETTE, strict=False):
        row["colour"] = colour
    stds = total.std_by_source_arcsec
    sources = [
        [name, quantity("backlash_arcsec.std").text(stds[key]) if key in stds else NOT_STATED]
        for key, name in SOURCES.items()
    ]
    return {"rows": rows, "sources": sources, "spread": spread_text(total)}


def _line(design: Design, total: Backlash, K_b: float, K_e: float) -> Message:
    """The positive branch; the negative one mirrors it."""
    load = design.load.torque_Nm
    torque = np.linspace(0, DRAWN_RATIO, LINE_POINTS) * load
    # at 0 itself it is the gap's middle; the line begins at the gap's end
    angle = angle_rad(design, np.maximum(torque, 1e-9 * load), K_b, K_e) * ARCSEC_PER_RAD
    return {
        "load_Nm": load,
        "load_text": f"{figures_text(load, 2)} N·m",
        "torque_Nm": torque.tolist(),
        "angle_arcsec": angle.tolist(),
        "spread_arcsec": band(torque, load, total).tolist(),
        "gap_arcsec": total.gap_arcsec,
    }
