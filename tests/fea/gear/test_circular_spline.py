"""The circular spline's rim against rings of closed form, and the rim's cone against its bound."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.gear.circular_spline import condensed_spline, spline_outline
from flexspline.fea.types import Elastic
from flexspline.geometry.load import load_design
from flexspline.pipeline.gear.gear_model import gear_model

STEEL = Elastic(206e3, 0.3)
DESIGN = load_design(EXAMPLES / "xb1-40.toml")


def test_turning_against_the_outside_is_shear_between_two_cylinders() -> None:
    """Even traction inside, outside held: u = T/(4π G b) (1/a² − 1/c²) a, T = 2π a per N/rad (Lamé)."""
    a, c, width = 20.0, 27.0, 8.0
    face = np.linspace(0, width, 3)
    found = condensed_spline(spline_outline(a, c, 0.0, width), STEEL, a, face, 4)
    shares = np.array([0.25, 0.5, 0.25])  # hats over the face
    moved = shares @ found.harmonics[0][3:, 3:] @ shares
    torque = 2 * pi * a
    expected = torque / (4 * pi * STEEL.mu * width) * (1 / a**2 - 1 / c**2) * a
    # the same all along z, so only the mesh of triangles is between them
    assert moved == pytest.approx(expected, rel=1e-3)


def test_breathing_is_a_thick_ring_under_pressure() -> None:
    """u = p a/E ((c² + a²)/(c² − a²) + ν) in plane stress; p a b = 1 N/rad (Lamé)."""
    a, c, width = 20.0, 27.0, 0.5  # short: plane stress
    found = condensed_spline(
        spline_outline(a, c, 0.0, width), STEEL, a, np.linspace(0, width, 3), 2
    )
    shares = np.array([0.25, 0.5, 0.25])
    moved = shares @ found.harmonics[0][:3, :3] @ shares
    pressure = 1 / (a * width)
    square = (c**2 + a**2) / (c**2 - a**2) + STEEL.poissons_ratio
    assert moved == pytest.approx(pressure * a / STEEL.youngs_modulus_MPa * square, rel=2e-3)


def test_a_pitch_point_inside_the_ring_turns_less_with_it() -> None:
    """Torsion turns all radii by one angle: u_θ is in proportion to the radius."""
    outline, face = spline_outline(20.0, 27.0, 0.0, 8.0), np.linspace(0, 8.0, 3)
    root, pitch = (condensed_spline(outline, STEEL, r, face, 2).harmonics[0] for r in (20.0, 19.8))
    # forces there have less lever too: (19.8/20)²
    assert pitch[3:, 3:] == pytest.approx(root[3:, 3:] * 0.99**2)


def test_the_rim_opens_as_a_cone_of_straight_generators() -> None:
    """Without strain u_r ∝ z from the closed end (Timoshenko, Theory of Plates and Shells, art. 122)."""
    model = gear_model(DESIGN, DESIGN.part("flexspline"), face_places=3)
    f, stroke = DESIGN.flexspline, model.mesh.stroke
    outwards, along = model.rim.cone(stroke)
    middle = (f.ring_start + f.ring_end) / 2
    expected = stroke / (middle - f.diaphragm_thickness_mm / 2)  # per mm
    slope = (outwards[2] - outwards[0]) / (
        2 / 3 * f.ring_width_mm
    )  # between the outer hats' centroids
    assert slope == pytest.approx(expected, rel=0.05)  # the closed end gives way a little
    assert model.rim.face @ outwards == pytest.approx(0, abs=1e-12)
    # v = −w/2 of an inextensible ring, at every z
    ratio = (along[2] - along[0]) / (outwards[2] - outwards[0])
    lift = 1.5 * model.mesh.height
    assert ratio == pytest.approx(lift - 0.5, abs=0.05)
