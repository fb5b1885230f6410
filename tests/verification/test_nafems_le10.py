"""NAFEMS LE10, thick plate under pressure: The Standard NAFEMS Benchmarks, TNSB rev. 3, 1990, LE10.

The plan of LE1, 0.6 m thick, 1 MPa on its upper surface; the outer face held in x and y, and in z
along its middle line; wanted: σyy at D on the upper surface: −5.38 MPa.
"""

from __future__ import annotations

import numpy as np
import pytest
from cartesian import X, Y, Z, cartesian_model, displacement, surface_load
from elliptic_plate import POINT_D, quarter

from flexspline.fea.solid.model import Supports
from flexspline.fea.solid.stress import nodal_stress
from flexspline.fea.types import Elastic

STEEL = Elastic(210e3, 0.3)
THICKNESS = 600.0
TARGET = -5.38


def stress_at_D(n: int, layers: int) -> float:
    mesh = quarter(n, THICKNESS, layers)
    model = cartesian_model(mesh, STEEL)
    supports = Supports(model)
    supports.set(mesh.nodes_on("y = 0"), Y)
    supports.set(mesh.nodes_on("x = 0"), X)
    outer = mesh.nodes_on("outer")
    supports.set(outer, X)
    supports.set(outer, Y)
    supports.set(outer[np.isclose(mesh.nodes[outer, Z], THICKNESS / 2)], Z)
    down = np.array([0.0, 0.0, -1.0])
    load = surface_load(mesh, "upper", lambda points: np.broadcast_to(down, points.shape))
    stress = nodal_stress(mesh, displacement(supports, load), STEEL)
    (corner,) = np.flatnonzero(np.isclose(mesh.nodes, [*POINT_D, THICKNESS]).all(axis=1))
    return float(stress[corner, Y, Y])


def test_le10_stress_at_d(record) -> None:
    """LE10: σyy(D) = −5.38 MPa."""
    coarse, fine = stress_at_D(4, 8), stress_at_D(4, 12)
    record("LE10 thick plate, σyy at D", "TNSB rev. 3, LE10", TARGET, fine, "MPa")
    assert coarse == pytest.approx(fine, rel=0.002)  # finer in plan too, 10 × 12: 0.1 % lower
    # our meshes settle at −5.41, 0.6 % from the target, which comes as three digits with no error;
    # half of the last digit and 0.2 % of mesh are the rest
    assert fine == pytest.approx(TARGET, rel=0.009)
