"""Gaps between drawn flanks: the closest approach of a moving tooth and its space.

Heights are over the pitch circles, which touch at full depth. A tooth's point (t, h), t its half thickness,
stands at x + t + h β and h − y − t β in its space, β the tooth's turn against the space. The space's half
width there is s, and the gap along the normal (s − x − t − h β) cos α, the least of all heights. Small turns.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos

import numpy as np


@dataclass(frozen=True)
class DrawnFlanks:
    """Half a tooth and half a space; lengths in mm.

    Attributes
    ----------
    heights, tooth : (h,), (h,) of the tooth's flank up to its tip.
    levels, space : (l,), (l,) of the space, from the circular spline's tip to the root; both rise.
    pressure_angle : of the flanks at the pitch circle [rad].
    """

    heights: np.ndarray
    tooth: np.ndarray
    levels: np.ndarray
    space: np.ndarray
    pressure_angle: float

    def gap(self, x: np.ndarray, y: np.ndarray, turn: np.ndarray) -> np.ndarray:
        """Front flank's (k,) [mm] at offsets x, withdrawals y [mm] and turns [rad]; inf where none meet."""
        h, t = self.heights, self.tooth
        across = x[:, None] + t + h * turn[:, None]
        level = h - y[:, None] - t * turn[:, None]
        room = np.interp(level, self.levels, self.space) - across
        meets = (level >= self.levels[0]) & (level <= self.levels[-1])
        return np.where(meets, room, np.inf).min(axis=1) * cos(self.pressure_angle)
