"""Flat elements are told by their thickness, whatever their size and place."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

from flexspline.fea.solid.flatness import FLAT_ASPECT, aspects, mostly_flat
from flexspline.fea.types import TetMesh

REGULAR = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])


def meshes(*corners: np.ndarray) -> TetMesh:
    """One with these tetrahedra; their middle nodes, which nothing here looks at, are corners."""
    nodes = np.concatenate(corners)
    cells = 4 * np.arange(len(corners))[:, None] + np.array([0, 1, 3, 2] + [0] * 6)
    return TetMesh(nodes, cells, np.empty((0, 6), int), np.empty(0, int), (), 360.0)


@pytest.mark.parametrize("size", [1e-3, 1.0, 70.0])
def test_aspect_of_a_regular_tetrahedron(size: float) -> None:
    # height over edge is √(2/3)
    assert aspects(meshes(size * REGULAR + 5.0)) == pytest.approx([sqrt(1.5)], rel=1e-9)


def test_a_right_corner_pressed_flat() -> None:
    corner = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0.01]])
    # the hypotenuse over the height; the sloping face is larger than the base by a part in 10⁴
    assert abs(aspects(meshes(corner[[0, 2, 1, 3]]))[0]) == pytest.approx(sqrt(2) / 0.01, rel=1e-3)


@pytest.mark.parametrize(("flat", "of"), [(1, 10), (2, 10)])
def test_more_than_a_tenth_makes_a_mesh_flat(flat: int, of: int) -> None:
    thin = REGULAR * [1.0, 1.0, 1 / (2 * FLAT_ASPECT)]
    mesh = meshes(*[thin] * flat, *[REGULAR] * (of - flat))
    assert mostly_flat(mesh) == (flat > of / 10)
