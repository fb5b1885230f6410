"""What the cuts change is not taken from nodes whose stress does not count."""

from __future__ import annotations

import numpy as np
import pytest
from hand_made_tube import tube

from flexspline.fea.solid.peak import SharpEdges
from flexspline.fea.solid.superposed_stress import FieldWithoutCuts, superposed_field
from flexspline.fea.types import Elastic

MESH = tube(30.0, 2)
NODE = int(np.hypot(MESH.nodes[:, 0], MESH.nodes[:, 1] + np.abs(MESH.nodes[:, 2] - 3)).argmin())
"""At the bore: the change has its largest stress there."""
EXCLUSION_mm = 0.01


def peak_MPa(beyond_mm: float) -> float:
    """The field without cuts is zero, and one of its own nodes lies so far beside NODE."""
    change = np.zeros_like(MESH.nodes)
    change[NODE] = 1e-3
    x, y, z = MESH.nodes[NODE]

    def nothing(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.zeros((len(points), 3)), np.zeros((len(points), 3, 3))

    without = FieldWithoutCuts(nothing, np.array([[np.hypot(x, y), z + beyond_mm]]), ())
    edges = SharpEdges(MESH.nodes[[NODE]], 30.0, EXCLUSION_mm)
    field = superposed_field(MESH, change, without, Elastic(206_000.0, 0.3), "made up", edges)
    return field.whole.peak.mises_MPa


def test_a_point_just_beyond_has_the_change_of_a_node_that_counts() -> None:
    inside, just_beyond = peak_MPa(0.5 * EXCLUSION_mm), peak_MPa(1.5 * EXCLUSION_mm)
    assert just_beyond == pytest.approx(inside, rel=1e-12)
