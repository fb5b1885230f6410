"""What the figures assume and where they end, in sentences that carry this design's numbers."""

from __future__ import annotations

from results.quantities import quantity
from results.report.content import ReportContent


def assumptions(content: ReportContent) -> list[list[str]]:
    """Pairs of heading and text."""
    design, b = content.design, content.backlash
    arcsec = quantity("backlash_arcsec.total")
    uniform = content.K_b_in_sum is content.K_b
    found = [
        [
            "Material and size of motion",
            "Isotropic and linear elastic, small displacements. Each part is solved alone; its "
            "mounting face is held, so the bolted joint between them counts as rigid.",
        ],
        ["Teeth", _teeth(content)],
        [
            "Where the torque enters",
            "K_b depends on it, which is why every K_b here carries its load case. The sum uses "
            + (
                "“uniform”, the ring turned rigidly."
                if uniform
                else "“lobes”, the torque at the two ends of the major axis."
            ),
        ],
        [
            "Wave generator",
            f"A given ellipse, w₀ cos 2φ with w₀ = {design.gear.centre_distance_mm:.3g} mm, that "
            "the seat follows without friction and without lifting off. In load case “lobes” the "
            "seat is held radially both ways, so it cannot lift off either.",
        ],
        ["Bearing play", _play(content)],
        [
            "Standard deviation",
            f"The {arcsec.text(b.std_arcsec)} {arcsec.unit} contain only what the design file "
            "states under “uncertainty”, taken as independent and normal. The error of the model "
            "itself is not in it.",
        ],
        [
            "Left out of the sum",
            "Friction hysteresis, stiffness that grows with load, temperature, wear, the "
            "compliance of circular spline, housing, bearings and bolts. Measured lost motion "
            "contains all of them and is as a rule larger and softer near zero torque.",
        ],
    ]
    peaks = [content.wave_generator_peak, content.flexspline_peak, content.shaft_peak]
    stated = {p.excluded for p in peaks if p is not None}
    if stated:
        found.append(
            [
                "Peak stress",
                "Left out of the peaks: "
                + "; ".join(sorted(stated))
                + ". No number there converges. Fillets count in full.",
            ]
        )
    return found


def fatigue(content: ReportContent) -> str:
    """The wave generator's stress against the stated fatigue limit; "" without a limit."""
    limit = content.design.material.flexspline.fatigue_limit_MPa
    peak = content.wave_generator_peak
    if limit is None or peak is None:
        return ""
    stress = quantity("wave_generator_peak_mises_MPa")
    beyond = " It is above that limit." if peak.mises_MPa > limit else ""
    return (
        f"The wave generator's ellipse alternates twice per turn: its peak of "
        f"{stress.with_unit(peak.mises_MPa)} is {100 * peak.mises_MPa / limit:.0f} % of the stated "
        f"fatigue limit of {limit:g} MPa.{beyond} Surface, size and mean stress are not considered."
    )


def _teeth(content: ReportContent) -> str:
    f, ring = content.design.flexspline, content.ring
    if ring is None:
        return (
            "Not drawn. The toothed ring is a plain ring of "
            f"{f.ring_thickness_mm:g} mm, the thickness under the tooth roots as "
            "the design file gives it; teeth that stiffen the ring must be in that figure."
        )
    bending, membrane, torsion = (
        quantity(f"equivalent_ring_thickness{leaf}_mm").with_unit(value)
        for leaf, value in (
            ("", ring.bending_mm),
            ("_membrane", ring.membrane_mm),
            ("_torsion", ring.torsion_mm),
        )
    )
    difference = quantity("equivalent_ring_difference_pct").with_unit(ring.difference_pct)
    return (
        f"Drawn with {f.tooth_flank} flanks on a rim of {f.ring_thickness_mm:g} mm. Every K_b uses a "
        f"plain ring of {bending}, {difference} more than the rim: it is as stiff in "
        f"bending. As stiff against growing all round would be {membrane}, against torsion about "
        f"the axis {torsion}. The mesh leaves less than {100 * ring.change:.1g} %; root fillets "
        "and the axial stiffness of the teeth are not in it. Stress at the tooth roots is not that "
        "of the plain ring."
    )


def _play(content: ReportContent) -> str:
    design, b = content.design, content.backlash
    arcsec = quantity("backlash_arcsec.total")
    if design.bearing.bearing_play_model == "involute":
        text = (
            "Involute model of the clearance; it ends at a play of "
            f"{design.gear.bearing_play_limit_um:.4g} µm "
            f"(here {design.bearing.radial_clearance_um:g} µm)."
        )
        other = "small-displacement"
    else:
        text = "Small-displacement model, j′ = c sin α."
        other = "involute"
    if b.model_form_arcsec is not None:
        sign = "more" if b.model_form_arcsec >= 0 else "less"
        text += (
            f" The {other} model gives {arcsec.text(abs(b.model_form_arcsec))} {arcsec.unit} "
            f"{sign}; that difference is error of the model, not part of the standard deviation."
        )
    if b.play_beyond_limit > 5e-4:
        text += (
            f" With probability {100 * b.play_beyond_limit:.2g} % the play lies beyond that end."
        )
    return text
