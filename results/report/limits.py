"""Assumptions and limits of the figures, in sentences with this design's numbers."""

from __future__ import annotations

from flexspline.geometry.design import Design
from flexspline.geometry.part_name import PART_NAMES
from flexspline.geometry.percent import percent
from flexspline.pipeline.first_face import excess, is_too_large, touches, why_too_large
from flexspline.pipeline.linear_limit import LinearLimit
from flexspline.pipeline.stress_limits import share_of_limit
from flexspline.results.doubt import spread_sentence
from flexspline.results.limit_words import reason
from flexspline.results.numbers import signed
from flexspline.results.peaks import BORDER, MEANING
from flexspline.results.quantities import quantity
from flexspline.results.report.content import ReportContent
from flexspline.results.sentences import sentence

ENTERS = {
    "uniform": "the ring is turned rigidly",
    "lobes": "the torque enters at the two ends of the major axis",
}
"""Where the torque enters, by `solver.load_case`."""
LEAST_BEYOND_LIMIT = 5e-4
"""Probability from which play beyond the involute model's end is said: 0.05 %."""


def assumptions(content: ReportContent) -> list[list[str]]:
    """Pairs of heading and text."""
    b = content.backlash
    case = content.design.solver.load_case
    pairs = [
        [
            "Material and size of motion",
            "Isotropic and linear elastic, small displacements. Each part is solved alone; its "
            "mounting face is held, so the bolted joint between them counts as rigid. The shaft is "
            f"held on its whole first face.{_beyond_flange(content.design)}",
        ],
        ["Teeth", _teeth(content)],
        [
            "Where the torque enters",
            "K_b depends on where the torque enters, so every K_b has its load case. The sum uses "
            f"“{case}”: {ENTERS[case]}.",
        ],
        ["Wave generator", _ellipse(content)],
        ["Bearing play", _play(content)],
        [
            "Standard deviation",
            f"{sentence(spread_sentence(b))} "
            + (
                "It includes only the values under “uncertainty” in the design file, as independent and "
                "normally distributed; it does not include the error of the model."
                if b.std_arcsec is not None
                else "To get one, state the uncertainties in the table “uncertainty” of the design file."
            ),
        ],
        [
            "Not in the sum",
            "Friction hysteresis, stiffness that grows with load, temperature, wear, and the "
            "compliance of circular spline, housing, bearings and bolts. Measured lost motion "
            "contains all of them; it is often larger, and a real gear is often softer near zero torque.",
        ],
    ]
    if content.linear_limit is not None:
        pairs.append(["Largest torque", _linear(content, content.linear_limit)])
    peaks = (content.wave_generator_peak or content.flexspline_peak, content.shaft_peak)
    stated = [
        f"{part}: {p.excluded}" for part, p in zip(PART_NAMES, peaks, strict=True) if p is not None
    ]
    if stated:
        flexspline_peak = content.flexspline_peak
        why = (
            f"Flexspline under torque: {flexspline_peak.stands_for}. "
            if flexspline_peak and flexspline_peak.stands_for
            else ""
        )
        pairs.append(
            [
                "Peak stress",
                f"{why}Excluded from the peaks: "
                + "; ".join(stated)
                + ". Values there do not converge with mesh refinement; fillets that are not named here are "
                "included. In service the stress from the wave generator and the stress from the torque act "
                "together; here they are given separately and not added. "
                + f"“{BORDER}” means: {MEANING}.",
            ]
        )
    return pairs


def fatigue(content: ReportContent) -> str:
    """The wave generator's stress against the stated fatigue limit; "" without a limit."""
    material, peak = content.design.material.flexspline, content.wave_generator_peak
    limit = material.fatigue_limit_MPa
    if limit is None or peak is None:
        return ""
    stress = quantity("wave_generator_peak_mises_MPa").with_unit(peak.mises_MPa)
    sentence = f"The stress of the wave generator's ellipse alternates twice per turn: its peak of {stress}"
    share = share_of_limit(peak, material)
    if share is not None:
        beyond = " It is above that limit." if share > 1 else ""
        return (
            f"{sentence} is {100 * share:.0f} % of the stated fatigue limit of {limit:g} MPa.{beyond} "
            "Surface, size, mean stress, tooth roots and the stress from the torque are not considered."
        )
    if peak.mises_MPa > limit:
        return (
            f"{sentence} is above the stated fatigue limit of {limit:g} MPa, and the stress rises further "
            "towards the nearby edge."
        )
    return (
        f"{sentence} lies at the border of the excluded zone, {peak.exclusion_mm:.3g} mm from an edge. The "
        "stress rises further towards this edge, so the peak does not show whether the part stays below the "
        f"stated fatigue limit of {limit:g} MPa."
    )


def _ellipse(content: ReportContent) -> str:
    """What the ellipse assumes of the seat, and how the stress moves with its width."""
    design, found = content.design, content.stiffnesses
    half = found.half_seat_peak
    width = design.flexspline.ring_width_mm
    text = (
        f"The seat follows a given ellipse, w₀ cos 2φ with w₀ = {design.w0_mm:.3g} mm, without friction and "
        "without lifting off. In load case “lobes” the seat is held radially in both directions, so it "
        f"cannot lift off. The seat is assumed as wide as the toothed ring, {width:g} mm, and cylindrical, "
        "so the ring cannot tilt. This assumption determines the stress."
    )
    if content.wave_generator_peak is None:
        return text
    if why := content.wave_generator_peak.stands_for:
        text += f" Peak stress: {why}."
    if half is None:
        return text
    stress = quantity("wave_generator_peak_half_seat_mises_MPa")
    full = found.full_seat_peak or content.wave_generator_peak
    change = 100 * (half.mises_MPa / full.mises_MPa - 1)
    digits = 0 if abs(change) >= 1 else 1
    with_holes = found.full_seat_peak is not None
    instead = f" instead of {stress.with_unit(full.mises_MPa)}" if with_holes else ""
    border = f", {BORDER}" if half.at_excluded_border else ""
    return (
        f"{text} With a seat half as wide, {width / 2:g} mm in the middle of the ring, the peak would be "
        f"{stress.with_unit(half.mises_MPa)}{instead} ({signed(change, digits)} %; "
        f"{'both ' if with_holes else ''}without bolt holes{border})."
    )


def _linear(content: ReportContent, limit: LinearLimit) -> str:
    """Up to which torque the figures are valid."""
    torque = content.design.load.torque_Nm
    least = quantity("linear_torque_limit_Nm").with_unit(limit.torque_Nm)
    return (
        f"Stiffness, stress and backlash are linear in the torque. They are not valid beyond {least}: there "
        f"{reason(limit)}. T_L is {100 * torque / limit.torque_Nm:.2g} % of this limit. Buckling, the teeth, "
        "the bolts, and the stress from the wave generator, which exists without torque, may lower this "
        f"limit; they are not included.{_buckles(content, limit)}"
    )


def _buckles(content: ReportContent, limit: LinearLimit) -> str:
    """Where the tube is estimated to buckle below that limit, the torque; else ""."""
    torque = content.gear.buckling_torque_Nm if content.gear else None
    if torque is None or torque >= limit.torque_Nm:
        return ""
    return (
        " The flexspline's tube is estimated to buckle at a lower torque, about "
        f"{quantity('buckling_torque_Nm').with_unit(torque)}."
    )


def _beyond_flange(design: Design) -> str:
    """What the whole face does to K_e of a hat's shaft."""
    if not is_too_large(design):
        return ""
    if not touches(design):
        return f" K_e is {why_too_large(design)}."
    share = excess(design)
    by = "" if share is None else f" by about {percent(share)}"
    return (
        f" The hat’s flange touches only the outer part of this face, so K_e is larger{by} than K_e of the "
        "same shaft held only there (computed with two bodies of revolution)."
    )


def _teeth(content: ReportContent) -> str:
    f, ring = content.design.flexspline, content.stiffnesses.ring
    if ring is None:
        return (
            "Not drawn. The toothed ring is a plain ring of "
            f"{f.ring_thickness_mm:g} mm, the thickness under the tooth roots as "
            "the design file gives it; if teeth stiffen the ring, this thickness must include their effect."
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
        f"plain ring of {bending}, {difference} thicker than the rim, with the bending stiffness of the "
        f"toothed ring. Equivalent thickness in hoop stiffness: {membrane}; in torsion about the axis: "
        f"{torsion}. The mesh error of these thicknesses is below {percent(ring.change, 1)}; root fillets "
        "and the axial stiffness of the teeth are not included. The stress at the tooth roots differs from "
        "the stress of the plain ring."
    )


def _play(content: ReportContent) -> str:
    design, b = content.design, content.backlash
    arcsec = quantity("backlash_arcsec.total")
    if design.bearing.bearing_play_model == "involute":
        text = (
            "Involute model of the clearance; it is valid up to a play of "
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
            f"{sign}; this difference is a model error and not part of the standard deviation."
        )
    if b.play_beyond_limit > LEAST_BEYOND_LIMIT:
        text += (
            f" The play exceeds this limit with a probability of {100 * b.play_beyond_limit:.2g} %."
        )
    return text
