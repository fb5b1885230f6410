"""Fillets of a shaft in its layered mesh."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import sqrt

import numpy as np

from flexspline.geometry.outline import SAME_mm
from flexspline.geometry.shaft_shape import Shaft


@dataclass(frozen=True)
class Fillet:
    """A fillet of this `radius` in the corner (`r`, `z`) [mm], above the corner (`up` 1) or below it (-1)."""

    r: float
    z: float
    radius: float
    up: int

    @property
    def far(self) -> float:
        """Its largest radius about the axis [mm]."""
        return self.r + self.radius

    @property
    def middle(self) -> float:
        """Radius of the arc's middle [mm]."""
        return self.far - self.radius * sqrt(0.5)

    @property
    def span(self) -> tuple[float, float]:
        """Lower and upper end, z [mm]."""
        low, high = sorted((self.z, self.z + self.up * self.radius))
        return low, high

    def height(self, r: np.ndarray) -> np.ndarray:
        """Return z of the arc [mm] at radii from `r` to `far`."""
        across = np.clip(self.far - r, 0.0, self.radius)
        return self.z + self.up * (self.radius - np.sqrt(self.radius**2 - across**2))


def fillets_of(shape: Shaft) -> list[Fillet]:
    """Return the fillets of a shaft, from the flange on."""
    if shape.fillet_mm <= SAME_mm:
        return []
    fillets, z = [], 0.0
    for below, above in pairwise(shape.segment):
        z += below.length_mm
        a, b = below.outer_diameter_mm / 2, above.outer_diameter_mm / 2
        if abs(a - b) > SAME_mm:
            fillets.append(Fillet(min(a, b), z, shape.fillet_mm, 1 if b < a else -1))
    return fillets
