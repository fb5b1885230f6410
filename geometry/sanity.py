"""Warnings for a design that can be built but has unusual values.

Nothing here refuses a design. The ranges are rules of thumb, wide enough for long cups and flat
hats.
"""

from __future__ import annotations

from collections.abc import Iterator

from flexspline.geometry.basic_rack import DEDENDUM
from flexspline.geometry.check_fillets import corner_wall
from flexspline.geometry.design import Design
from flexspline.geometry.fields import UM_PER_MM
from flexspline.geometry.module_fit import module_hint, root_radius_mm, with_fitting_module
from flexspline.geometry.outline import SAME_mm
from flexspline.geometry.percent import percent
from flexspline.geometry.rated import rated_warnings

ROOT_TOLERANCE = 0.15
"""[modules] Difference of tooth-root radius and ring radius, above which one of the two is taken for a
slip."""
WALL_RATIO = (0.005, 0.025)
"""Usual range of wall thickness over inner diameter."""
SMALLEST_CLEARANCE_um = 0.1
"""Smallest usual clearance of flanks and bearings, except 0: a coordinate measuring machine does not resolve
less."""
LARGEST_CLEARANCE = 0.1
"""Usual flank clearance over a tooth's thickness, at most: makers aim at none, and worn gears have a few per
cent."""
BALL_RATIO = (0.1, 0.35)
"""Usual range of ball diameter over the tube's inner radius: flexible bearings in papers have 0.15 to
0.25."""
LENGTH_RATIO = (0.2, 1.4)
"""Usual range of length over inner diameter."""
LEAST_RATIO = 25
"""Smallest usual z1/(z2 − z1): catalogues begin at 30."""


def warnings(design: Design) -> tuple[str, ...]:
    """One line for everything unusual, each with its numbers; empty for a usual design."""
    rules = (
        _root_radius,
        _proportions,
        _bending,
        _corner,
        _grip,
        _wave_generator_room,
        _bolts,
        _by_module,
        _micrometres,
        _balls,
        _ratio,
    )
    return tuple(line for rule in rules for line in rule(design))


def _by_module(design: Design) -> Iterator[str]:
    """Of values that the module judges: what neither it nor the one that the ring asks for spares."""
    judged = with_fitting_module(design)
    for rule in (_play_edge, _clearance, rated_warnings):
        if any(rule(design)):
            yield from rule(judged)


def ring_bending_stress_MPa(design: Design) -> float:
    """Stress of the toothed ring bent to the wave generator's ellipse [MPa].

    σ = E/(1 − ν²)·(t/2)·3w0/R², a thin ring under w0 cos 2φ (ring theory), with t the ring's
    thickness, R its middle radius and w0 as stated, else m(z2 − z1)/2.
    """
    f, material = design.flexspline, design.material.flexspline
    middle = f.inner_radius + f.ring_thickness_mm / 2
    plane = material.youngs_modulus_MPa / (1 - material.poissons_ratio**2)
    return plane * f.ring_thickness_mm / 2 * 3 * design.w0_mm / middle**2


def _root_radius(design: Design) -> Iterator[str]:
    gear, ring = design.gear, design.flexspline.ring_radius
    root = root_radius_mm(design)
    difference, allowed = abs(root - ring), ROOT_TOLERANCE * gear.module_mm
    if hint := module_hint(design):
        yield f"tooth-root radius {root:.4g} mm, ring's outer radius {ring:.4g} mm: {hint}"
    elif root < design.flexspline.inner_radius:
        yield (
            f"tooth-root radius m(z1/2 - {DEDENDUM}) = {root:.4g} mm lies inside the tube, whose inner "
            f"radius is {design.flexspline.inner_radius:.4g} mm: gear.module_mm, gear.teeth_flexspline or "
            "flexspline.inner_diameter_mm is wrong"
        )
    elif difference > allowed:
        yield (
            f"tooth-root radius m(z1/2 - {DEDENDUM}) = {root:.4g} mm, but the ring's outer radius "
            f"is {ring:.4g} mm: they differ by {difference:.3g} mm, and should by at most {ROOT_TOLERANCE} "
            f"module = {allowed:.3g} mm{_fitting_ring(design, root)}"
        )


def _fitting_ring(design: Design, root_mm: float) -> str:
    """The ring's thickness that puts its outside to the root, or the tube's diameter."""
    f = design.flexspline
    fits = root_mm - f.inner_radius
    if fits >= f.wall_thickness_mm:
        return f"; flexspline.ring_thickness_mm = {fits:.4g} would fit"
    return f"; flexspline.inner_diameter_mm = {2 * (root_mm - f.ring_thickness_mm):.4g} would fit"


def _proportions(design: Design) -> Iterator[str]:
    f = design.flexspline
    for name, value, (low, high) in (
        ("wall_thickness_mm", f.wall_thickness_mm, WALL_RATIO),
        ("length_mm", f.length_mm, LENGTH_RATIO),
    ):
        ratio = value / f.inner_diameter_mm
        if not low <= ratio <= high:
            yield (
                f"flexspline.{name} / inner_diameter_mm = {value:g} / {f.inner_diameter_mm:g} = "
                f"{ratio:.3g}, usually {low:g} to {high:g}"
            )


def _bending(design: Design) -> Iterator[str]:
    limit = design.material.flexspline.fatigue_limit_MPa
    stress = ring_bending_stress_MPa(design)
    if limit is not None and stress > limit:
        yield (
            f"bending the ring to the wave generator takes about {stress:.0f} MPa, above "
            f"material.flexspline.fatigue_limit_MPa = {limit:g}"
        )


def _corner(design: Design) -> Iterator[str]:
    f = design.flexspline
    wall, usual = corner_wall(f), min(f.wall_thickness_mm, f.diaphragm_thickness_mm)
    if wall < 0.5 * usual:
        yield (
            f"between inner_fillet_mm = {f.inner_fillet_mm:g} and outer_fillet_mm = "
            f"{f.outer_fillet_mm:g} only {wall:.3g} mm of wall is left, below half of {usual:g} mm"
        )


def _grip(design: Design) -> Iterator[str]:
    """A step is easily clamped by mistake, and hardly any shaft is left that twists."""
    shaft = design.shaft
    last = shaft.segment[-1].length_mm
    if len(shaft.segment) > 1 and shaft.grip_length_mm > last + SAME_mm:
        yield (
            f"shaft.grip_length_mm = {shaft.grip_length_mm:g} is longer than the last segment, {last:g} mm: "
            f"the step is clamped too, and only {shaft.length - shaft.grip_length_mm:.4g} of "
            f"{shaft.length:g} mm twist"
        )


def _wave_generator_room(design: Design) -> Iterator[str]:
    f = design.flexspline
    reaches = f"the {'wave generator' if f.inward else 'circular spline'}'s place"
    if f.hole_depth > f.ring_start:
        yield (
            f"flexspline.{f.land.thickness} = {f.hole_depth:g} reaches above the ring's lower edge z = "
            f"{f.ring_start:g} mm, {reaches}"
        )


def _bolts(design: Design) -> Iterator[str]:
    f, s = design.flexspline, design.shaft
    for key in ("bolt_count", "bolt_circle_diameter_mm", "bolt_hole_diameter_mm"):
        ours, theirs = getattr(f, key), getattr(s, key)
        if f.bolt_count and s.bolt_count and ours != theirs:
            yield (
                f"flexspline.{key} = {ours:g}, but shaft.{key} = {theirs:g}: the two are bolted to each "
                "other, so make them equal"
            )


def _play_edge(design: Design) -> Iterator[str]:
    c, s = design.bearing.radial_clearance_um, design.uncertainty.radial_clearance_um
    limit = design.gear.bearing_play_limit_um
    if design.bearing.bearing_play_model == "involute" and s and c + 2 * s > limit:
        yield (
            f"bearing.radial_clearance_um = {c:g} ± {s:g} comes within two deviations of c_max = "
            f"{limit:.4g} µm at {design.gear.pressure_angle_deg:g}°, where the involute model ends"
        )


def _micrometres(design: Design) -> Iterator[str]:
    for key, value in (
        ("gear.flank_clearance_um", design.gear.flank_clearance_um),
        ("bearing.radial_clearance_um", design.bearing.radial_clearance_um),
    ):
        if 0 < value < SMALLEST_CLEARANCE_um:
            yield f"{key} = {value:g} is below {SMALLEST_CLEARANCE_um:g} µm: was it given in mm?"


def _clearance(design: Design) -> Iterator[str]:
    clearance, thick = design.gear.flank_clearance_um, UM_PER_MM * design.gear.tooth_thickness_mm
    if clearance > LARGEST_CLEARANCE * thick:
        yield (
            f"gear.flank_clearance_um = {clearance:g} is {percent(clearance / thick)} of a tooth's "
            f"thickness, {thick:.4g} µm; usually below {percent(LARGEST_CLEARANCE)}"
        )


def _balls(design: Design) -> Iterator[str]:
    ball, radius = design.wave_generator.ball_diameter_mm, design.flexspline.inner_radius
    low, high = BALL_RATIO
    if ball is not None and not low <= ball / radius <= high:
        yield (
            f"wave_generator.ball_diameter_mm = {ball:g} is {ball / radius:.3g} of the tube's inner radius, "
            f"usually {low:g} to {high:g}"
        )


def _ratio(design: Design) -> Iterator[str]:
    gear = design.gear
    if gear.ratio < LEAST_RATIO:
        yield (
            f"z1/(z2 - z1) = {gear.teeth_flexspline}/{gear.more_teeth} = {gear.ratio:.3g}, usually 30 or "
            f"more: is gear.teeth_circular_spline = {gear.teeth_circular_spline} right?"
        )
