"""The meshing space: a sector of a part with its angle unrolled into a length.

A ring-shaped part becomes a prism there: cylinders become planes, which the mesher keeps exactly, and
an unrolling radius below the tube's makes elements longer around the circumference than along the
meridian, where the fields change fastest.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians
from typing import Protocol

import numpy as np

from flexspline.fea.solid.polar import cartesian


class MeshingMap(Protocol):
    """A one-to-one map between part space and the space in which the part is meshed."""

    def to(self, points: np.ndarray) -> np.ndarray: ...
    def back(self, points: np.ndarray) -> np.ndarray: ...


@dataclass(frozen=True)
class Cartesian:
    """Mesh the part as it is."""

    def to(self, points: np.ndarray) -> np.ndarray:
        return points

    def back(self, points: np.ndarray) -> np.ndarray:
        return points


@dataclass(frozen=True)
class Unrolled:
    """(x, y, z) → (r, φ·radius, z); for sectors below 360° that do not touch the axis."""

    radius: float
    sector_deg: float

    def to(self, points: np.ndarray) -> np.ndarray:
        middle = radians(self.sector_deg) / 2
        phi = np.arctan2(points[:, 1], points[:, 0]) - middle
        phi = (phi + np.pi) % (2 * np.pi) - np.pi + middle
        r = np.hypot(points[:, 0], points[:, 1])
        return np.column_stack([r, phi * self.radius, points[:, 2]])

    def back(self, points: np.ndarray) -> np.ndarray:
        return cartesian(points / [1.0, self.radius, 1.0])
