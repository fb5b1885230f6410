"""Each law of the whole gear against a closed form or the numbers of a hand calculation."""

from __future__ import annotations

from math import cos, log, pi, radians, sin

import numpy as np
import pytest

from flexspline.fea.gear.ball import ball_between_races, point_contact
from flexspline.fea.gear.kinematics import ToothMesh
from flexspline.fea.gear.tooth_pair import clamped, flank_contact, tooth
from flexspline.fea.types import Elastic
from flexspline.geometry.circular_spline import DEEPEST

STEEL = Elastic(206e3, 0.3)


def mesh(clearance: float = 0.0, height: float = 0.0) -> ToothMesh:
    """Module 0.2, 200 and 202 teeth, 20°."""
    return ToothMesh(20.0, 2 / 202, 0.2, clearance, radians(20), height)


def test_a_ball_on_a_plane_is_hertz_s_closed_form() -> None:
    """δ³ = 9 F²/(16 E*² R)."""
    radius, force = 2.0, 50.0
    reduced = STEEL.youngs_modulus_MPa / (2 * (1 - STEEL.poissons_ratio**2))
    expected = (9 * force**2 / (16 * reduced**2 * radius)) ** (1 / 3)
    assert point_contact(1 / radius, 1 / radius, STEEL) * force ** (2 / 3) == pytest.approx(
        expected
    )


def test_an_ellipse_of_contact_meets_the_tables() -> None:
    """Against Hamrock and Brewe's fit (J. Lubr. Technol. 105 (1983) 171-177), good to 3 %.

    k = (R_y/R_x)^(2/π), E = 1 + (π/2 − 1)/(R_y/R_x), F = π/2 + (π/2 − 1) ln(R_y/R_x),
    δ = F (9/(2 E R) (W/(π k E'))²)^(1/3) with E' = E/(1 − ν²) of two like bodies.
    """
    along, across, force = 1.2, 0.05, 40.0
    ratio = along / across  # R_y/R_x
    k, second = ratio ** (2 / pi), 1 + (pi / 2 - 1) / ratio
    first = pi / 2 + (pi / 2 - 1) * log(ratio)
    reduced = STEEL.youngs_modulus_MPa / (1 - STEEL.poissons_ratio**2)
    spread = (force / (pi * k * reduced)) ** 2
    depth = first * (9 / 2 * (along + across) / second * spread) ** (1 / 3)
    assert point_contact(along, across, STEEL) * force ** (2 / 3) == pytest.approx(depth, rel=0.03)


def test_closer_grooves_are_stiffer() -> None:
    close, wide = (ball_between_races(4.0, 18.4, f, STEEL) for f in (0.51, 0.56))
    assert close < wide


def test_a_straight_cantilever() -> None:
    """α = 0: F l³/(3 E' I) and 1.2 F l/(G A), the rest is the root's."""
    lever, thick, width = 6.0, 0.5, 2.0
    plane = STEEL.youngs_modulus_MPa / (1 - STEEL.poissons_ratio**2)
    inertia = width * thick**3 / 12
    beam = lever**3 / (3 * plane * inertia) + 1.2 * lever / (STEEL.mu * thick * width)
    slender = lever / thick
    nu = STEEL.poissons_ratio
    root = 16.67 / pi * slender**2 + 2 * (1 - nu - 2 * nu**2) / (1 - nu**2) * slender + 1.534
    # held at the root a beam cannot narrow there: stiffer by some (t/l)²
    own = tooth(lever, thick, 0.0, 0.5, width, STEEL)
    assert own == pytest.approx(beam + root / plane / width, rel=0.01)


def test_a_slender_wedge() -> None:
    """α = 3°: the beam of variable section, cos α y − sin α t/2 its moment."""
    lever, thick, alpha = 6.0, 1.0, radians(3)
    plane = STEEL.youngs_modulus_MPa / (1 - STEEL.poissons_ratio**2)
    c, s = cos(alpha), sin(alpha)
    y = np.linspace(0, lever, 2001)
    t = thick + 2 * y * np.tan(alpha)
    moment = c * y - s * thick / 2
    energy = 12 * moment**2 / (plane * t**3) + 1.2 * c**2 / (STEEL.mu * t) + s**2 / (plane * t)
    assert clamped(lever, thick, alpha, 1.0, STEEL) == pytest.approx(
        float(np.trapezoid(energy, y)), rel=0.02
    )


def test_a_pair_yields_as_its_size_asks() -> None:
    """In the plane only the width has a scale: ten times the module is as stiff."""
    small, large = (tooth(1.25 * m, pi * m / 2, radians(20), m, 8.0, STEEL) for m in (0.2, 2.0))
    assert small == pytest.approx(large)
    assert flank_contact(16.0, STEEL) == pytest.approx(flank_contact(8.0, STEEL) / 2)


def test_gaps_of_plain_flanks_by_hand() -> None:
    """α = 20°, thin rim: 0.07 w0 larger at 45° than at 0, −0.064 w0 at 60°, y = 1.34 w0 at 55°."""
    at = mesh(clearance=0.004)
    front, back = at.free_gaps(np.radians([0.0, 45.0, 60.0]), 0.2)
    w0, s, c = 0.2, sin(radians(20)), cos(radians(20))
    assert front[0] == back[0] == pytest.approx(0.002)
    rise = w0 * (s - (pi / 4 * 200 / 202 - 0.5) * c)  # r_p φ (z2 − z1)/z2 = w0 φ z1/z2
    assert front[1] - front[0] == pytest.approx(rise)
    # the hand calculation has φ for φ z1/z2: 1 % of φ
    assert (front[1] - front[0]) / w0 == pytest.approx(0.07, abs=0.015)
    assert (front[2] - front[0]) / w0 == pytest.approx(-0.064, abs=0.015)
    assert 1 - np.cos(2 * at.reach) == pytest.approx(DEEPEST)
    assert np.degrees(at.reach) == pytest.approx(55.0, abs=0.1)


def test_the_back_flank_is_the_front_one_s_mirror() -> None:
    at, phi = mesh(0.003, 0.026), np.radians(np.linspace(-50, 50, 11))
    front, back = at.free_gaps(phi, 0.2)
    assert front == pytest.approx(back[::-1])
    ahead, behind = at.relief(phi)
    assert ahead == pytest.approx(behind[::-1])


def test_relieved_flanks_never_come_closer_farther_out() -> None:
    at = mesh(0.003, 0.026)
    phi = np.linspace(0, at.reach, 300)
    relieved = at.free_gaps(phi, at.stroke)[0] + at.relief(phi)[0]
    assert np.diff(relieved).min() > -1e-7
    assert at.largest_relief > 0.01  # plain ones do: by more than 10 µm


def test_a_section_that_turns_takes_the_pitch_point_along() -> None:
    """v + h (v − w′)/R of w = w0 cos 2φ, v = −(w0/2) sin 2φ, by finite differences."""
    at, phi, d = mesh(height=0.03), np.linspace(-1, 1, 9), 1e-6
    w, v = (lambda p: 0.2 * np.cos(2 * p)), (lambda p: -0.1 * np.sin(2 * p))
    slope = (w(phi + d) - w(phi - d)) / (2 * d)
    assert at.shift(phi, 0.2) == pytest.approx(v(phi) + 0.03 * (v(phi) - slope), abs=1e-9)


@pytest.mark.parametrize(("teeth", "each"), [(100, 1.0), (200, 1.0), (320, 160 / 128)])
def test_stations_stand_for_all_teeth(teeth: int, each: float) -> None:
    angles, per_station = mesh().stations(teeth, 128)
    assert per_station == pytest.approx(each)
    assert 0.0 in angles
    assert np.abs(angles).max() <= mesh().reach
    assert np.diff(angles) == pytest.approx(2 * pi / teeth * each)
