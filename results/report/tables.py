"""The report's tables as rows of finished text."""

from __future__ import annotations

from collections.abc import Iterator

from flexspline.geometry.design import Design
from flexspline.geometry.material import ElasticMaterial, Material
from flexspline.geometry.shapes import Flexspline
from flexspline.pipeline.stiffnesses import series_bounds_Nm_per_rad
from flexspline.pipeline.stress_limits import PART_OF, limits_passed
from flexspline.results.doubt import as_stated, spread_text
from flexspline.results.limit_words import beside_figure, stiffness_notes
from flexspline.results.numbers import beyond, grouped, with_power
from flexspline.results.peaks import BORDER, border_note, half_seat_words, limit_note
from flexspline.results.quantities import bounds_kind, quantity
from flexspline.results.quantity import Quantity
from flexspline.results.report.content import ReportContent
from flexspline.results.report.dimensions import ratio, weights
from flexspline.results.sentences import capital

PrintedRow = dict[str, str]
UNCHECKED = "–"
"""Stands where a check was not made."""


def answers(content: ReportContent) -> list[PrintedRow]:
    """Every answer with its symbol, unit and bounds."""
    rows = [_backlash_row(content)]
    series = quantity("K_series_Nm_per_rad")
    found, case = content.stiffnesses, content.design.solver.load_case
    K_b, K_e = found.in_sum(content.design), found.K_e
    bounds = series.range_text(*series_bounds_Nm_per_rad(K_b, K_e))
    both = K_b.guaranteed and K_e.guaranteed
    rows.append(
        _row(series, found.series_Nm_per_rad(content.design), bounds)
        | {"note": f"with {content.sum_symbol} (load case “{case}”)", "kind": bounds_kind(both)}
    )
    notes = stiffness_notes(content.design)
    for name, stiffness in found.solved.items():
        entry = quantity(f"{name}_Nm_per_rad")
        bounds = entry.range_text(*stiffness.bounds_Nm_per_rad)
        row = _row(entry, stiffness.K_Nm_per_rad, bounds)
        remarks = filter(None, (entry.note, notes.get(entry.key)))
        rows.append(row | {"note": "; ".join(remarks), "kind": bounds_kind(stiffness.guaranteed)})
    return rows + _stress_rows(content)


def solves(content: ReportContent) -> list[PrintedRow]:
    """How each stiffness was solved: model, piece, size, checks."""
    rows = []
    for name, s in content.stiffnesses.solved.items():
        last = s.levels[-1]
        tolerance_pct = content.design.solver.tolerance_pct
        half, check = 100 * s.half_width, last.K_check_Nm_per_rad
        rows.append(
            {
                "symbol": quantity(f"{name}_Nm_per_rad").symbol,
                "model": s.model,
                "symmetry": s.symmetry,
                "meshes": str(len(s.levels)),
                "elements": quantity("solver.elements").text(last.elements),
                "dofs": quantity("solver.dofs").text(last.dofs),
                "half_width": f"± {beyond(half, tolerance_pct)} %",
                "wide": "yes" if half > tolerance_pct else "",
                "kind": bounds_kind(s.guaranteed),
                "residual": UNCHECKED if last.residual is None else with_power(last.residual),
                "energy": UNCHECKED
                if check is None
                else with_power(abs(check / last.K_Nm_per_rad - 1)),
                "method": capital(s.method.rstrip(".")),
            }
        )
    return rows


def design_facts(design: Design) -> tuple[tuple[str, str], ...]:
    """Pairs of name and value that say what was asked about."""
    f, gear = design.flexspline, design.gear
    segments, doubt = design.shaft.segment, design.uncertainty
    flanks = as_stated(gear.flank_clearance_um, doubt.flank_clearance_um, "µm")
    play = as_stated(design.bearing.radial_clearance_um, doubt.radial_clearance_um, "µm")
    spread = " (1σ)" if "±" in flanks + play else "; 1σ not stated"
    size = (
        f"{f.kind}; inner diameter {f.inner_diameter_mm:g}, wall {f.wall_thickness_mm:g}, "
        f"length {f.length_mm:g}, diaphragm {f.diaphragm_thickness_mm:g} mm"
    )
    return (
        ("Flexspline", f"{size}; {_end(f)}; {_holes(f.bolt_count)}"),
        (
            "Toothed ring",
            f"{f.ring_thickness_mm:g} mm thick under the roots, {f.ring_width_mm:g} mm wide",
        ),
        (
            "Output shaft",
            f"length {grouped(design.shaft.length, 1)} mm in {len(segments)} segments, outer "
            f"diameters {', '.join(f'{s.outer_diameter_mm:g}' for s in segments[:6])}"
            f"{', …' if len(segments) > 6 else ''} mm; {_holes(design.shaft.bolt_count)}"
            f"{'; keyway' if design.shaft.keyway else ''}",
        ),
        *_materials(design),
        ("Mass", weights(design)),
        (
            "Gear",
            f"module {gear.module_mm:g} mm, {gear.teeth_flexspline}/{gear.teeth_circular_spline} "
            f"teeth, ratio {ratio(design)}, pressure angle {gear.pressure_angle_deg:g}°",
        ),
        (
            "Clearances",
            f"flanks {flanks} normal, wave-generator bearing {play} radial{spread}",
        ),
    )


def _backlash_row(content: ReportContent) -> PrintedRow:
    entry = quantity("backlash_arcsec.total")
    return _row(entry, content.backlash.total_arcsec, spread_text(content.backlash)) | {
        "note": f"between −T_L and +T_L, T_L = {content.design.load.torque_Nm:g} N·m"
    }


def _stress_rows(content: ReportContent) -> list[PrintedRow]:
    rows = []
    wave, torque = quantity("wave_generator_peak_mises_MPa"), quantity("torque_peak_mises_MPa")
    for entry, name, peak in (
        (wave, "wave_generator_peak", content.wave_generator_peak),
        (torque, "torque_peak", content.flexspline_peak),
        (quantity("shaft_torque_peak_mises_MPa"), "shaft_torque_peak", content.shaft_peak),
    ):
        if peak is not None:
            passed = [beside_figure(p) for p in limits_passed(content.design, {name: peak})]
            part, (x, y, z) = PART_OF[name], peak.at_mm
            remarks = [f"{part}, r = {(x * x + y * y) ** 0.5:.2f} mm, z = {z:.2f} mm"]
            if peak.at_excluded_border:
                remarks.append(border_note(peak.exclusion_mm, peak.mises_at_twice_MPa))
            if not (passed and peak.at_excluded_border):
                remarks.append(limit_note(peak, content.design.part(part).material))
            half, full = content.stiffnesses.half_seat_peak, content.stiffnesses.full_seat_peak
            if entry is wave and half is not None:
                words = half_seat_words(
                    half.mises_MPa, half.at_excluded_border, full.mises_MPa if full else None
                )
                remarks.append(f"seat as wide as the ring; {words}")
            rows.append(
                _row(entry, peak.mises_MPa, "")
                | {"note": "; ".join(remarks), "alarm": "; ".join(passed)}
                | {
                    "tile": "; ".join(passed)
                    or (BORDER if peak.at_excluded_border else "von Mises")
                }
            )
    return rows


def _row(entry: Quantity, value: float, bounds: str) -> PrintedRow:
    return {
        "name": entry.name,
        "symbol": entry.symbol,
        "value": entry.text(value),
        "unit": entry.unit,
        "bounds": bounds,
    }


def _end(f: Flexspline) -> str:
    """What bolts to the shaft."""
    land = f.land
    inner, outer = (f"{f.size(key):g}" for key in (land.inner, land.outer))
    if f.inward:
        return f"{land.noun} ⌀ {outer} × {f.hole_depth:g}, bore ⌀ {inner} mm"
    return f"{land.noun} ⌀ {inner} to {outer} × {f.hole_depth:g} mm"


def _holes(count: int) -> str:
    return f"{count} bolt holes" if count else "no bolt holes"


def _materials(design: Design) -> Iterator[tuple[str, str]]:
    of = design.material
    flexspline, shaft = of.flexspline, design.part("shaft").material
    if flexspline == shaft:
        yield "Material, both parts", _material(flexspline)
    else:
        yield "Material, flexspline", _material(flexspline)
        yield "Material, shaft", _material(shaft)
    if of.circular_spline:
        yield "Material, circular spline", _elastic(of.circular_spline)
    if of.bearing:
        yield "Material, races and balls", _elastic(of.bearing)


def _elastic(m: ElasticMaterial) -> str:
    return f"{m.name}: E = {m.youngs_modulus_GPa:g} GPa, ν = {m.poissons_ratio:g}"


def _material(m: Material) -> str:
    limit = f", fatigue limit {m.fatigue_limit_MPa:g} MPa" if m.fatigue_limit_MPa else ""
    density = f"{m.density_kg_per_m3:g} kg/m³"
    if not m.density_stated:
        density += " (of steel, not stated)"
    return f"{_elastic(m)}{limit}, density {density}"
