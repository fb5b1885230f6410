"""The quarter plate between two ellipses that NAFEMS LE1 and LE10 share, mm."""

from __future__ import annotations

from math import pi

import numpy as np
from cartesian import at
from structured import bent_box

from flexspline.fea.types import TetMesh

INNER, OUTER = np.array([2000.0, 1000.0]), np.array([3250.0, 2750.0])
POINT_D = np.array([2000.0, 0.0])


def quarter(n: int, thickness: float, layers: int) -> TetMesh:
    """2n × 3n cells in plan, crowded towards the hole and the x axis, where D is.

    Patches: "inner", "outer", "x = 0", "y = 0", "lower", "upper".
    """
    across = np.linspace(0, 1, 2 * n + 1) ** 2
    around = np.linspace(0, 1, 3 * n + 1) ** 1.5 * pi / 2
    z = np.linspace(0, thickness, layers + 1)

    def ellipses(c: np.ndarray) -> np.ndarray:
        axes = INNER + c[:, :1] * (OUTER - INNER)
        return np.column_stack(
            [axes[:, 0] * np.cos(c[:, 1]), axes[:, 1] * np.sin(c[:, 1]), c[:, 2]]
        )

    return bent_box(
        across, around, z, ellipses,
        {
            "inner": at(0, 0.0), "outer": at(0, 1.0), "y = 0": at(1, 0.0), "x = 0": at(1, pi / 2),
            "lower": at(2, 0.0), "upper": at(2, thickness),
        },
    )  # fmt: skip
