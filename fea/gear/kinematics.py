"""Where each tooth stands in its space while the wave generator stretches the rim and nothing is loaded.

φ from the major axis. The rim moves by w = w0 cos 2φ outwards and v = −(w0/2) sin 2φ along itself, as a thin
ring that does not stretch (Timoshenko, Strength of Materials II, art. 14); a tooth's pitch point, h over the
ring's middle line R, goes with the section: v + (h/R) (v − w′) = v + (3/2)(h/R) w0 sin 2φ.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from scipy.optimize import brentq

LARGEST_WITHDRAWAL = 1.34
"""Of w0: y = w0 (1 − cos 2φ) at 55°, where plain flanks of 20° begin to cut into each other."""
NEAR = pi / 6
"""Where plain flanks are meant to meet; a flank that comes closer than there farther out interferes."""


STEPS = 200
"""Of a search for a gap's least: parabolas are met to 1e-5."""


@dataclass(frozen=True)
class Mesh:
    """Two toothed rings, one stretched by w0 into the other; mm and rad.

    Attributes
    ----------
    pitch_radius : r_p = m z1/2.
    lag : (z2 − z1)/z2: a tooth at φ stands r_p φ lag from the middle of its space.
    stroke : m (z2 − z1)/2, with which the teeth mesh to full depth.
    clearance : j_bn0, of both flanks together, along their normal.
    pressure_angle : of the flanks.
    height : of the pitch circle over the rim's middle line, over the radius of that line.
    """

    pitch_radius: float
    lag: float
    stroke: float
    clearance: float
    pressure_angle: float
    height: float

    def offset(self, phi: np.ndarray) -> np.ndarray:
        """x [mm], along the pitch circle, of the tooth at φ in its space, before the rim moves."""
        return self.pitch_radius * phi * self.lag

    def shift(self, phi: np.ndarray, deflection: float) -> np.ndarray:
        """v at the pitch point [mm]."""
        return deflection * (1.5 * self.height - 0.5) * np.sin(2 * phi)

    def gaps(
        self, phi: np.ndarray, outwards: np.ndarray, along: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Normal gaps g+ and g− [mm] of the two flanks of teeth whose pitch points have moved so far [mm].

        g± = j/2 + y sin α ∓ x cos α with the withdrawal y = stroke − u_r and x = offset + u_θ.
        """
        s, c = sin(self.pressure_angle), cos(self.pressure_angle)
        level = self.clearance / 2 + (self.stroke - outwards) * s
        across = (self.offset(phi) + along) * c
        return level - across, level + across

    def free_gaps(self, phi: np.ndarray, deflection: float) -> tuple[np.ndarray, np.ndarray]:
        """The same on the ideal rim, w0 = `deflection`."""
        return self.gaps(phi, deflection * np.cos(2 * phi), self.shift(phi, deflection))

    @property
    def reach(self) -> float:
        """φ [rad] up to which teeth can touch: there they leave the working depth, or plain flanks interfere."""
        leaves = float(np.arccos(1 - LARGEST_WITHDRAWAL) / 2)

        def nearest(phi: np.ndarray) -> np.ndarray:
            return np.minimum(*self.free_gaps(phi, self.stroke))

        least = float(nearest(np.linspace(0, NEAR, STEPS)).min())
        far = np.linspace(NEAR, leaves, STEPS)
        closer = np.flatnonzero(nearest(far) < least)
        if not len(closer):
            return leaves
        if closer[0] == 0:
            return NEAR
        ends = far[closer[0] - 1], far[closer[0]]
        return float(brentq(lambda phi: float(nearest(np.array([phi]))[0]) - least, *ends))

    @property
    def interferes(self) -> bool:
        """Whether plain flanks would cut into each other within the working depth."""
        return self.reach < float(np.arccos(1 - LARGEST_WITHDRAWAL) / 2) - 1e-9

    def stations(self, teeth: int, most: int) -> tuple[np.ndarray, float]:
        """Angles of the teeth within reach, one of them on the major axis, and teeth per station.

        With more than `most` teeth in half a turn, `most` stations stand for them.
        """
        count = min(teeth / 2, most)
        step = pi / count
        k = int(self.reach / step)
        return step * np.arange(-k, k + 1), teeth / 2 / count
