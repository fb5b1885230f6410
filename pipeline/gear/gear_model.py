"""Builds the contact model of the whole gear from a design."""

from __future__ import annotations

from functools import lru_cache
from math import radians

import numpy as np

from flexspline.fea.gear.ball import ball_between_races
from flexspline.fea.gear.circular_spline import condensed_spline, spline_outline
from flexspline.fea.gear.condensed import Condensed
from flexspline.fea.gear.drawn_flanks import DrawnFlanks
from flexspline.fea.gear.kinematics import ToothMesh
from flexspline.fea.gear.model import GearModel
from flexspline.fea.gear.outer_race import condensed_race, race_outline
from flexspline.fea.gear.plug import Plug
from flexspline.fea.gear.rim import Rim, condensed_rim, places_along
from flexspline.fea.gear.tooth_pair import flank_contact, tooth
from flexspline.fea.threads import one_thread
from flexspline.fea.types import Elastic
from flexspline.geometry.basic_rack import ADDENDUM, DEDENDUM
from flexspline.geometry.circular_spline import circular_spline
from flexspline.geometry.design import Design
from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Shaft
from flexspline.geometry.tooth import flank
from flexspline.geometry.wave_generator import FlexibleBearing, flexible_bearing
from flexspline.geometry.whole_gear import require_whole_gear

LAST_HARMONIC = 48
"""Highest Fourier harmonic. With 96, K1 to K3 of xb1-40 change by 0.2 %; with 144 by 0.3 %."""
PLACES = 5
"""Contact places along the seat. With 7, K changes by 0.15 %; with 3, K1 changes by 2 %. On a rigid plug, of
which only the edge carries load, 9 are 5 % softer, like a three-dimensional model (docs/whole-gear.md)."""
FACE_PLACES = {"relieved": 5, "straight": 9}
"""Contact places along a tooth, closer together at its ends, which touch first. Relieved teeth: with 9, K
changes by 0.2 %; with 3, K1 of the hat by 5 %. Straight teeth: with 13, K changes by 0.4 %."""
FLANK_POINTS = 65
"""Points on a drawn flank; the error of a chord is then below 0.01 µm."""
MOST_STATIONS = 128
"""Most teeth that are modelled in half a turn; with more teeth, each modelled tooth represents several. 50
for 100 teeth change K by 0.6 %."""
CONFORMITY = 0.52
"""Groove radius over ball diameter, as usual in deep groove bearings (Harris and Kotzalas, chapter 2)."""
GROOVE_SHARE = 0.3
"""Width on which a ball loads its race, over the diameter of the ball: the load spreads through the race.
With half of it K changes by up to 0.5 %."""

KEPT_BODIES = 64
"""Condensed bodies kept in memory, 10 kB each: a change of the bearing does not need a new condensation of
the flexspline."""
LEAST_LEVER = 0.2
"""[modules] Smallest distance from the root to the pitch circle; on rings that reach farther out, the tooth
is a stub of this length."""


def gear_model(
    design: Design, flexspline: Part, places: int | None = None, face_places: int | None = None
) -> GearModel:
    """Return the contact model of the gear without its shaft and bolt holes.

    `flexspline` is the design's, but for drawn teeth, which are the plain ring as stiff. `places`: along the
    seat, at which the rim can touch; None: PLACES. `face_places`: along a tooth; None: FACE_PLACES.

    Raises
    ------
    DesignError : the design has no whole gear.
    ComputationError : no mesh or no solution.
    """
    require_whole_gear(design)
    bearing, spline, gear = flexible_bearing(design), circular_spline(design), design.gear
    shape = flexspline.shape
    assert not isinstance(shape, Shaft)
    pitch = gear.pitch_radius_mm
    middle = (shape.inner_radius + shape.ring_radius) / 2
    mesh = ToothMesh(
        pitch_radius=pitch,
        lag=gear.more_teeth / gear.teeth_circular_spline,
        stroke=gear.centre_distance_mm,
        clearance=gear.flank_clearance_mm,
        pressure_angle=radians(gear.pressure_angle_deg),
        height=(pitch - middle) / middle,
        flanks=gear.flanks,
        depth=spline.working_depth / gear.centre_distance_mm,
        face=gear.tooth_face,
        drawn=drawn_flanks(design) if gear.flanks == "drawn" else None,
    )
    groove = min(GROOVE_SHARE * bearing.ball_diameter, shape.ring_width_mm / 2)
    ring, count = (shape.ring_start, shape.ring_end), places or PLACES
    face = face_places or FACE_PLACES[gear.tooth_face]
    rigid = Elastic.of(design.material.of_circular_spline)
    races = Elastic.of(design.material.of_bearing)
    inside = gear.circular_spline_pitch_radius_mm
    return GearModel(
        mesh,
        _wave_generator(bearing, shape.inner_radius, design.bearing.radial_clearance_mm, races),
        _rim(flexspline.without_holes(), pitch, ring, count, face),
        _race(shape.inner_radius, bearing.race_thickness, races, ring, groove, count),
        _spline(spline.root, spline.outer, rigid, inside, ring, face),
        pair_compliance(design),
        gear.teeth_flexspline,
        MOST_STATIONS,
    )


@lru_cache(KEPT_BODIES)
def _rim(
    part: Part, pitch_radius: float, ring: tuple[float, float], count: int, face_count: int
) -> Rim:
    material, seat = Elastic.of(part.material), places_along(*ring, count)
    face = places_along(*ring, face_count)
    with one_thread():
        return condensed_rim(part.meridian, material, pitch_radius, face, seat, LAST_HARMONIC)


@lru_cache(KEPT_BODIES)
def _spline(
    root: float,
    outer: float,
    material: Elastic,
    pitch_radius: float,
    ring: tuple[float, float],
    face_count: int,
) -> Condensed:
    outline, face = spline_outline(root, outer, *ring), places_along(*ring, face_count)
    with one_thread():
        return condensed_spline(outline, material, pitch_radius, face, LAST_HARMONIC)


@lru_cache(KEPT_BODIES)
def _race(
    outer_radius: float,
    thickness: float,
    material: Elastic,
    seat: tuple[float, float],
    groove: float,
    count: int,
) -> Condensed:
    outline = race_outline(outer_radius, thickness, *seat, groove)
    places = places_along(*seat, count)
    with one_thread():
        return condensed_race(outline, material, places, LAST_HARMONIC)


def _wave_generator(
    bearing: FlexibleBearing, inner_radius: float, play: float, material: Elastic
) -> Plug:
    hertz = ball_between_races(
        bearing.ball_diameter, inner_radius - bearing.race_thickness, CONFORMITY, material
    )
    return Plug(bearing.deflection, play, even(bearing.ball_count), hertz)


def even(balls: int) -> int:
    """Return the next even number: two lobes share the balls evenly."""
    return balls + balls % 2


def drawn_flanks(design: Design) -> DrawnFlanks:
    """Return flanks of the drawn tooth, and of the space that its basic rack cuts into the circular spline.

    An internal gear's space is the tooth of an external one. Both reach from a module inside the pitch circle
    (the circular spline's tip; a tooth's root may be nearer) to one outside.
    """
    gear, kind = design.gear, design.flexspline.tooth_flank
    alpha = radians(gear.pressure_angle_deg)

    def half(teeth: int, heights: np.ndarray) -> np.ndarray:
        angle = flank(kind, gear.module_mm, teeth, alpha)
        radii = gear.module_mm * teeth / 2 + heights
        return np.array([r * angle(r) for r in radii.tolist()])

    module = gear.module_mm
    pitch = gear.pitch_radius_mm
    root = max(design.flexspline.ring_radius - pitch, -ADDENDUM * module)
    heights = np.linspace(root, ADDENDUM * module, FLANK_POINTS)
    levels = np.linspace(-ADDENDUM * module, DEDENDUM * module, FLANK_POINTS)
    tooth, space = half(gear.teeth_flexspline, heights), half(gear.teeth_circular_spline, levels)
    return DrawnFlanks(heights, tooth, levels, space, alpha)


def pair_compliance(design: Design) -> float:
    """Return the compliance of a pair of equally large teeth at the pitch point [mm/N]."""
    f, gear = design.flexspline, design.gear
    pitch = gear.pitch_radius_mm
    material = design.material
    materials = Elastic.of(material.flexspline), Elastic.of(material.of_circular_spline)
    lever = max(pitch - f.ring_radius, LEAST_LEVER * gear.module_mm)
    teeth = (
        tooth(
            lever, gear.tooth_thickness_mm, radians(gear.pressure_angle_deg), ADDENDUM * gear.module_mm,
            f.ring_width_mm, steel,
        )
        for steel in materials
    )  # fmt: skip
    return sum(teeth) + flank_contact(f.ring_width_mm, *materials)
