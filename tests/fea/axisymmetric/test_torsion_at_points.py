"""Torsion at any point of a body of revolution, against the tube's closed form."""

from __future__ import annotations

import numpy as np
import pytest
from axisymmetric_shapes import tube

from flexspline.fea.axisymmetric.meridian_mesh import MeshingError
from flexspline.fea.axisymmetric.stress import torsion_stress
from flexspline.fea.axisymmetric.torsion_at_points import TorsionAtPoints
from flexspline.fea.types import Elastic

STEEL = Elastic(206e3, 0.3)
INNER_mm, OUTER_mm, LENGTH_mm = 6.0, 9.0, 20.0


@pytest.fixture(scope="module")
def turned() -> TorsionAtPoints:
    outline = tube(INNER_mm, OUTER_mm, LENGTH_mm)
    return TorsionAtPoints(torsion_stress(outline, STEEL, "grip", 7.0, 1.0, 0.005))


def test_displacement_and_stress_of_a_tube(turned: TorsionAtPoints) -> None:
    rng = np.random.default_rng(5)
    r, phi, z = (
        rng.uniform(*e, 200) for e in ((INNER_mm, OUTER_mm), (-np.pi, np.pi), (0, LENGTH_mm))
    )
    points = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)
    around = np.stack([-np.sin(phi), np.cos(phi), 0 * phi], axis=1)
    # a turn of 1 rad of the far end: u = r z/L along φ, τ_φz = μ r/L, exactly (Saint-Venant)
    displacement, stress = turned.at(points)
    assert displacement == pytest.approx((r * z / LENGTH_mm)[:, None] * around, abs=1e-9)
    shear = STEEL.mu * r / LENGTH_mm
    expected = np.zeros((len(r), 3, 3))
    expected[:, :, 2] = expected[:, 2, :] = shear[:, None] * around
    assert stress == pytest.approx(expected, abs=1e-6 * STEEL.mu)


def test_a_point_off_the_body_is_refused(turned: TorsionAtPoints) -> None:
    with pytest.raises(MeshingError, match="not on the meridian"):
        turned.at(np.array([[OUTER_mm + 1.0, 0.0, 5.0]]))
