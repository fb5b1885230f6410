"""Deviation of a simulated torque-angle curve from a straight line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

NUMERICAL_SHARE = 0.005
"""Share of the wind-up: the most by which the number of harmonics, places and stations changes K
(docs/whole-gear.md)."""


@dataclass(frozen=True)
class Bend:
    """An odd function of torque: 0 at 0 and at the last torque.

    `torque_Nm` (k,) rises from 0; `angle_arcsec` (k,) is the curve's angle less half the gap and the chord.
    Beyond the last torque the last slope goes on.
    """

    torque_Nm: tuple[float, ...]
    angle_arcsec: tuple[float, ...]

    def scaled(self, factor: float) -> Bend:
        """The bend of a gear that is so many times softer all over."""
        return Bend(self.torque_Nm, tuple(factor * a for a in self.angle_arcsec))

    def at(self, torque_Nm: np.ndarray) -> np.ndarray:
        """(n,) arcsec."""
        known, angle = np.array(self.torque_Nm), np.array(self.angle_arcsec)
        size = np.abs(torque_Nm)
        slope = (angle[-1] - angle[-2]) / (known[-1] - known[-2])
        beyond = slope * np.maximum(size - known[-1], 0.0)
        return np.sign(torque_Nm) * (np.interp(size, known, angle) + beyond)
