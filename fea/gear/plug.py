"""The wave generator: a rigid plug, w0 cos 2φ larger than a circle, and its balls."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np


@dataclass(frozen=True)
class Plug:
    """The plug of the wave generator and its balls.

    Attributes
    ----------
    deflection : w0 [mm].
    play : c [mm]: each ball has half of it.
    balls : how many, even.
    hertz : C of each ball [mm/N^(2/3)].
    """

    deflection: float
    play: float
    balls: int
    hertz: float

    @property
    def angles(self) -> np.ndarray:
        """Of the balls over half a turn [rad], one on the major axis."""
        return 2 * pi / self.balls * np.arange(self.balls // 2)

    def gap(self, phi: np.ndarray) -> np.ndarray:
        """Between plug and a circle at φ [mm], with half of the play; below 0 it stretches the circle."""
        return self.play / 2 - self.deflection * np.cos(2 * phi)
