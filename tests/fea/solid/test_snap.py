"""Boundary nodes on their surfaces: at smooth joints."""

from __future__ import annotations

from math import cos

import numpy as np
import pytest

from flexspline.fea.solid.snap import snap_middles
from flexspline.geometry.outline import Segment
from flexspline.geometry.surfaces import Swept

R_mm, JOINT_mm = 10.0, 3.0
TUBE = Swept(Segment((R_mm, JOINT_mm), (R_mm, 10.0)))
FILLET = Swept(
    Segment((R_mm + 1.5, JOINT_mm - 1.5), (R_mm, JOINT_mm), centre=(R_mm + 1.5, JOINT_mm))
)
"""They meet at z = 3 mm without an edge."""
OPENING = 0.2
"""[rad] Of the edge that both facets share."""
LIMIT_mm = 0.2
"""More than the way from the edge's middle to the joint."""


def on(surface: Swept, angle: float, z_mm: float) -> np.ndarray:
    point = np.array([[R_mm * np.cos(angle), R_mm * np.sin(angle), z_mm]])
    return surface.project(point)[0]


def middle_of_shared_edge(second_z_mm: float) -> np.ndarray:
    """Of a facet on the tube and one on the fillet; the edge begins on the joint."""
    first, second = on(TUBE, 0.0, JOINT_mm), on(TUBE, OPENING, second_z_mm)
    corners = np.array([first, second, on(TUBE, 0.1, 4.0), on(FILLET, 0.1, 2.5)])
    edges = np.array([[0, 1], [1, 2], [0, 2], [0, 3], [1, 3]])
    nodes = np.vstack([corners, corners[edges].mean(axis=1)])
    facets = np.array([[0, 1, 2, 4, 5, 6], [1, 0, 3, 4, 7, 8]])
    return snap_middles(nodes, edges, facets, np.array([0, 1]), [TUBE, FILLET], LIMIT_mm)[4]


@pytest.mark.parametrize("beside_mm", [0.1, 0.25])
def test_middle_of_an_edge_across_a_smooth_joint_stays_between_its_ends(beside_mm: float) -> None:
    x, y, z = middle_of_shared_edge(JOINT_mm + beside_mm)
    # it may move by the height of the arc over its chord, outward, and not along the part
    assert np.hypot(x, y) == pytest.approx(R_mm, abs=beside_mm**2)
    assert z == pytest.approx(JOINT_mm + beside_mm / 2, abs=R_mm * (1 - cos(OPENING / 2)) / 10)


def test_middle_of_an_edge_along_a_smooth_joint_lies_on_it() -> None:
    x, y, z = middle_of_shared_edge(JOINT_mm)
    assert (np.hypot(x, y), z) == pytest.approx((R_mm, JOINT_mm), abs=1e-6)
