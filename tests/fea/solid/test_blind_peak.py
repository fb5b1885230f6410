"""A peak in an element that reaches from a sharp edge: a rise towards the edge cannot be seen."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.fea.solid.peak import SharpEdges, Stresses, largest_of
from flexspline.fea.solid.quadratic import with_middles
from flexspline.fea.types import StressPeak, TetMesh

CORNER = np.vstack([np.zeros(3), np.eye(3)])
FACES = np.array([[0, 1, 2]])
ELEMENT = np.array([[0, 1, 2, 3]])


def peak_of(first_x_mm: float, elements: bool) -> StressPeak:
    """Stress that is even up to 1 mm from the edge x = 0 and falls beyond, as an element smears it.

    The element with the peak goes from `first_x_mm` to 1 mm.
    """
    x = np.linspace(0.0, 3.0, 301)
    stress = np.zeros((len(x), 3, 3))
    stress[:, 0, 0] = np.where(x <= 1.0, 100.0, 100.0 - 30.0 * (x - 1.0))
    corners = np.array([first_x_mm, 0.0, 0.0]) + CORNER * (1.0 - first_x_mm)
    edges, cells, facets = with_middles(corners, ELEMENT, FACES)
    nodes = np.vstack([corners, corners[edges].mean(axis=1)])
    mesh = TetMesh(nodes, cells, facets, np.zeros(1, int), ("",), 90.0)
    line = np.stack([x, 0 * x, 0 * x], axis=1)
    edge = np.stack([0 * x, 0 * x, np.linspace(0.0, 3.0, len(x))], axis=1)
    return largest_of(
        [Stresses(line, stress)], SharpEdges(edge, 90.0, 1.0), mesh if elements else None
    )


@pytest.mark.parametrize(
    ("first_x_mm", "elements", "at_border"),
    [(0.0, True, True), (0.6, True, False), (0.0, False, False)],
)
def test_it_is_at_the_border_if_it_falls_beyond(
    first_x_mm: float, elements: bool, at_border: bool
) -> None:
    """The second element begins 0.6 mm from the edge: what is between would show a rise."""
    peak = peak_of(first_x_mm, elements)
    assert peak.mises_MPa == pytest.approx(100.0)
    assert peak.mises_at_twice_MPa == pytest.approx(70.0)
    assert peak.at_excluded_border is at_border
