"""Torsion at any point of a body of revolution, against the tube's closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from axisymmetric_shapes import tube

from flexspline.fea.axisymmetric.field_at_points import FieldAtPoints
from flexspline.fea.axisymmetric.meridian_mesh import MeshingError
from flexspline.fea.axisymmetric.stress import torsion_stress
from flexspline.fea.types import Elastic

STEEL = Elastic(206e3, 0.3)
INNER_mm, OUTER_mm, LENGTH_mm = 6.0, 9.0, 20.0


@pytest.fixture(scope="module")
def turned() -> FieldAtPoints:
    outline = tube(INNER_mm, OUTER_mm, LENGTH_mm)
    return FieldAtPoints(torsion_stress(outline, STEEL, "grip", 7.0, 1.0, 0.005))


def test_displacement_and_stress_of_a_tube(turned: FieldAtPoints) -> None:
    rng = np.random.default_rng(5)
    r, phi, z = (
        rng.uniform(*e, 200) for e in ((INNER_mm, OUTER_mm), (-np.pi, np.pi), (0, LENGTH_mm))
    )
    points = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)
    around = np.stack([-np.sin(phi), np.cos(phi), 0 * phi], axis=1)
    # a turn of 1 rad of the far end: u = r z/L along φ, τ_φz = μ r/L, exactly (Saint-Venant)
    displacement, stress = (values / turned.turn for values in turned.at(points))
    assert displacement == pytest.approx((r * z / LENGTH_mm)[:, None] * around, abs=1e-9)
    shear = STEEL.mu * r / LENGTH_mm
    expected = np.zeros((len(r), 3, 3))
    expected[:, :, 2] = expected[:, 2, :] = shear[:, None] * around
    assert stress == pytest.approx(expected, abs=1e-6 * STEEL.mu)


def test_a_point_just_outside_has_the_values_beside_it(turned: FieldAtPoints) -> None:
    """A mesher's nodes are 1e-6 mm off the surface, anywhere between the meridian's own nodes."""
    z = np.linspace(0.0, LENGTH_mm, 301)
    points = np.stack([0 * z + OUTER_mm + 1e-6, 0 * z, z], axis=1)
    displacement, _ = (values / turned.turn for values in turned.at(points))
    assert displacement[:, 1] == pytest.approx(OUTER_mm * z / LENGTH_mm, abs=1e-9)


def test_a_harmonic_in_cartesian_components() -> None:
    """u = ε (x, −y, 0), pure shear: U = ε r and V = −ε r of cos 2φ and sin 2φ."""
    known = torsion_stress(tube(INNER_mm, OUTER_mm, LENGTH_mm), STEEL, "grip", 7.0, 1.0, 0.05)
    strain, r = 1e-3, known.places[:, 0]
    pull = 2 * STEEL.mu * strain
    amplitudes = np.stack([0 * r + pull, 0 * r - pull, 0 * r, 0 * r, 0 * r - pull, 0 * r], axis=1)
    moved = strain * np.stack([r, -r, 0 * r], axis=1)
    at = FieldAtPoints(replace(known, n=2, displacement=moved, stress=amplitudes))
    points = np.array([[7.0, 0.5, 3.0], [-2.0, 8.0, 9.0], [-5.0, -5.0, 12.0], [3.0, -7.5, 1.0]])
    displacement, stress = at.at(points)
    assert displacement == pytest.approx(strain * points * [1, -1, 0], abs=1e-12)
    assert stress == pytest.approx(np.tile(np.diag([pull, -pull, 0.0]), (4, 1, 1)), abs=1e-6)


def test_a_point_off_the_body_is_refused(turned: FieldAtPoints) -> None:
    with pytest.raises(MeshingError, match="not on the meridian"):
        turned.at(np.array([[OUTER_mm + 1.0, 0.0, 5.0]]))
