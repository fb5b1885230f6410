"""The report's tables as rows of finished text."""

from __future__ import annotations

from fea.types import Stiffness
from geometry.design import Cup, Design, Material
from results.quantities import Quantity, grouped, quantity
from results.report.content import ReportContent

Row = dict[str, str]
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def answers(content: ReportContent) -> list[Row]:
    """Every answer with its symbol, unit and bounds."""
    lobes_in_sum = content.K_b_in_sum is not content.K_b
    rows = [_backlash_row(content)]
    series = quantity("K_series_Nm_per_rad")
    low, high = content.K_series_bounds_Nm_per_rad
    case = "lobes" if lobes_in_sum else "uniform"
    rows.append(
        _row(series, content.K_series_Nm_per_rad, series.range_text(low, high))
        | {"note": f"with K_b of load case “{case}”"}
    )
    notes = {
        "K_b_Nm_per_rad": "ring turned rigidly, mount held",
        "K_b_lobes_Nm_per_rad": "cos² traction within ±30° of the major axis, seat held radially",
        "K_b_lobes_contact_Nm_per_rad": "same traction, the rim rests on the seat and may lift off",
        "K_b_lobes_unsupported_Nm_per_rad": "same traction, nothing on the seat",
        "K_e_Nm_per_rad": "grip turned rigidly, mount held",
    }
    for key, stiffness in stiffnesses(content).items():
        entry = quantity(key)
        bounds = entry.range_text(stiffness.lower_Nm_per_rad, stiffness.upper_Nm_per_rad)
        rows.append(_row(entry, stiffness.K_Nm_per_rad, bounds) | {"note": notes[key]})
    return rows + _stress_rows(content)


def stiffnesses(content: ReportContent) -> dict[str, Stiffness]:
    """The stiffnesses that were solved, by quantity key, in the report's order."""
    every = {
        "K_b_Nm_per_rad": content.K_b,
        "K_b_lobes_Nm_per_rad": content.K_b_lobes,
        "K_b_lobes_contact_Nm_per_rad": content.K_b_lobes_contact,
        "K_b_lobes_unsupported_Nm_per_rad": content.K_b_lobes_unsupported,
        "K_e_Nm_per_rad": content.K_e,
    }
    return {key: found for key, found in every.items() if found is not None}


def budget(content: ReportContent) -> list[Row]:
    """The four terms and their sum: value and share."""
    b = content.backlash
    rows = []
    for term in ("shaft", "flexspline", "flank_clearance", "bearing_play", "total"):
        entry = quantity(f"backlash_arcsec.{term}")
        value = getattr(b, f"{term}_arcsec")
        share = f"{100 * value / b.total_arcsec:.0f} %"
        rows.append(_row(entry, value, "") | {"share": share, "term": term})
    return rows


def solves(content: ReportContent) -> list[Row]:
    """How each stiffness was solved: model, piece, size, checks."""
    rows = []
    for key, s in stiffnesses(content).items():
        last = s.levels[-1]
        half = 50 * (s.upper_Nm_per_rad - s.lower_Nm_per_rad) / s.K_Nm_per_rad
        rows.append(
            {
                "symbol": quantity(key).symbol,
                "model": s.model,
                "symmetry": s.symmetry,
                "meshes": str(len(s.levels)),
                "elements": quantity("solver.elements").text(last.elements),
                "dofs": quantity("solver.dofs").text(last.dofs),
                "half_width": f"±{half:.2g} %",
                "wide": "yes" if half > content.design.solver.tolerance_pct else "",
                "residual": _power(last.residual),
                "energy": _power(abs(last.K_reaction_Nm_per_rad / last.K_Nm_per_rad - 1)),
                "method": s.method[:1].upper() + s.method[1:].rstrip("."),
            }
        )
    return rows


def design_facts(design: Design) -> list[list[str]]:
    """Pairs of name and value that say what was asked about."""
    f, gear = design.flexspline, design.gear
    segments = design.shaft.segment
    size = (
        f"inner diameter {f.inner_diameter_mm:g}, wall {f.wall_thickness_mm:g}, "
        f"length {f.length_mm:g}, diaphragm {f.diaphragm_thickness_mm:g} mm"
    )
    return [
        ["Flexspline", f"{'cup' if isinstance(f, Cup) else 'hat'}; {size}; {_holes(f.bolt_count)}"],
        [
            "Toothed ring",
            f"{f.ring_thickness_mm:g} mm thick under the roots, {f.ring_width_mm:g} mm wide",
        ],
        [
            "Output shaft",
            f"length {grouped(design.shaft.length, 1)} mm in {len(segments)} segments, outer "
            f"diameters {', '.join(f'{s.outer_diameter_mm:g}' for s in segments[:6])}"
            f"{', …' if len(segments) > 6 else ''} mm; {_holes(design.shaft.bolt_count)}"
            f"{'; keyway' if design.shaft.keyway else ''}",
        ],
        *_materials(design),
        [
            "Gear",
            f"module {gear.module_mm:g} mm, {gear.teeth_flexspline}/{gear.teeth_circular_spline} "
            f"teeth, pressure angle {gear.pressure_angle_deg:g}°",
        ],
        [
            "Clearances",
            f"flanks {gear.flank_clearance_um:g} ± {design.uncertainty.flank_clearance_um:g} µm "
            f"normal, wave-generator bearing {design.bearing.radial_clearance_um:g} ± "
            f"{design.uncertainty.radial_clearance_um:g} µm radial (1σ)",
        ],
        ["Load torque", f"±{design.load.torque_Nm:g} N·m at the output, wave generator locked"],
    ]


def _backlash_row(content: ReportContent) -> Row:
    entry = quantity("backlash_arcsec.total")
    std = quantity("backlash_arcsec.std").text(content.backlash.std_arcsec)
    return _row(entry, content.backlash.total_arcsec, f"± {std} (1σ)") | {
        "note": f"between −T_L and +T_L, T_L = {content.design.load.torque_Nm:g} N·m"
    }


def _stress_rows(content: ReportContent) -> list[Row]:
    rows = []
    wave, torque = quantity("wave_generator_peak_mises_MPa"), quantity("torque_peak_mises_MPa")
    for entry, part, peak in (
        (wave, "flexspline", content.wave_generator_peak),
        (torque, "flexspline", content.flexspline_peak),
        (torque, "shaft", content.shaft_peak),
    ):
        if peak is not None:
            x, y, z = peak.at_mm
            place = f"{part}, r = {(x * x + y * y) ** 0.5:.2f} mm, z = {z:.2f} mm"
            rows.append(_row(entry, peak.mises_MPa, "") | {"note": place})
    return rows


def _row(entry: Quantity, value: float, bounds: str) -> Row:
    return {
        "name": entry.name,
        "symbol": entry.symbol,
        "value": entry.text(value),
        "unit": entry.unit,
        "bounds": bounds,
    }


def _power(value: float) -> str:
    """Order of magnitude of a rounding-size number, ``3·10⁻⁶``."""
    if not value:
        return "0"
    digit, exponent = f"{value:.0e}".split("e")
    return f"{digit}·10" + str(int(exponent)).translate(_RAISED)


def _holes(count: int) -> str:
    return f"{count} bolt holes" if count else "no bolt holes"


def _materials(design: Design) -> list[list[str]]:
    flexspline, shaft = design.material.flexspline, design.shaft_material
    if flexspline == shaft:
        return [["Material, both parts", _material(flexspline)]]
    return [
        ["Material, flexspline", _material(flexspline)],
        ["Material, shaft", _material(shaft)],
    ]


def _material(m: Material) -> str:
    limit = f", fatigue limit {m.fatigue_limit_MPa:g} MPa" if m.fatigue_limit_MPa else ""
    return f"{m.name}: E = {m.youngs_modulus_GPa:g} GPa, ν = {m.poissons_ratio:g}{limit}"
