"""Shape functions of the six-node triangle: corners, then the middles of 01, 12, 02."""

from __future__ import annotations

from functools import cache

import numpy as np

CORNERS_AND_MIDDLES = np.array([[0, 1, 0, 0.5, 0.5, 0], [0, 0, 1, 0, 0.5, 0.5]])
"""(2, 6) places of the nodes in the reference triangle."""


def shape_functions(at: np.ndarray) -> np.ndarray:
    """Return scikit-fem's P2 shape functions (6, q) at points (2, q) of the reference triangle.

    `interpolate` finds a field's gradients too: where only values are asked for, smoothed stresses and those
    at the lattice of a peak, it would make `stiffness` of hat-25 1.05 times as long (0.23 of 4.9 s).
    """
    from skfem import ElementTriP2

    element = ElementTriP2()
    return np.stack([element.lbasis(at, i)[0] for i in range(6)])


@cache
def lattice_values(steps: int) -> np.ndarray:
    """Return the shape functions (6, q) on a lattice of `steps` along each side."""
    i, j = np.meshgrid(np.arange(steps + 1), np.arange(steps + 1), indexing="ij")
    inside = i + j <= steps
    return shape_functions(np.stack([i[inside], j[inside]]) / steps)
