"""Position of each tooth in its space with the wave generator inserted and without load.

φ from the major axis. The rim moves by w = w0 cos 2φ outwards and v = −(w0/2) sin 2φ along itself, as a thin
ring that does not stretch (Timoshenko, Strength of Materials II, art. 14); a tooth's pitch point, h over the
ring's middle line R, goes with the section: v + (h/R) (v − w′) = v + (3/2)(h/R) w0 sin 2φ.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Literal

import numpy as np

from flexspline.fea.gear.drawn_flanks import DrawnFlanks
from flexspline.geometry.circular_spline import DEEPEST

Flanks = Literal["plain", "relieved", "conjugate", "drawn"]
Face = Literal["relieved", "straight"]
GAP_STEPS = 1000
"""Steps in the search for the largest value of a gap; the top of a parabola is found to 1e-6 of its
height."""


@dataclass(frozen=True)
class ToothMesh:
    """Two toothed rings, one stretched by w0 into the other; mm and rad.

    Attributes
    ----------
    pitch_radius : r_p = m z1/2.
    lag : (z2 − z1)/z2: a tooth at φ stands r_p φ lag from the middle of its space.
    stroke : m (z2 − z1)/2, with which the teeth mesh to full depth.
    clearance : j_bn0, of both flanks together, along their normal.
    pressure_angle : of the flanks.
    height : of the pitch circle over the rim's middle line, over the radius of that line.
    flanks : "plain": straight; "relieved": straight, but no gap of the unloaded gear is smaller than one that
        is nearer to the major axis; "conjugate": shaped so that all gaps of the front flanks are alike;
        "drawn": by the shapes in `drawn`.
    depth : largest withdrawal at which teeth touch, of the stroke.
    face : "relieved": shaped so that the ideal rim's cone leaves all of the face the same gap; "straight".
    """

    pitch_radius: float
    lag: float
    stroke: float
    clearance: float
    pressure_angle: float
    height: float
    flanks: Flanks = "relieved"
    depth: float = DEEPEST
    face: Face = "relieved"
    drawn: DrawnFlanks | None = None

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

    def closing(
        self, phi: np.ndarray, outwards: np.ndarray, along: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """What u_r = outwards cos 2φ, u_θ = along sin 2φ take off front and back gaps [mm]."""
        s, c = sin(self.pressure_angle), cos(self.pressure_angle)
        level, across = s * outwards * np.cos(2 * phi), c * along * np.sin(2 * phi)
        return level + across, level - across

    @property
    def reach(self) -> float:
        """φ [rad] at which teeth leave the working depth."""
        return float(np.arccos(1 - self.depth) / 2)

    def relief(self, phi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What is taken off the front and the back flanks at φ [mm], for the ideal rim; less than 0: added.

        Plain flanks come closer again far from the major axis. Teeth that should run are relieved there: as
        much as it takes that no gap is smaller than one nearer to the axis. Drawn ones: what their shapes and
        the tooth's turn in its space change.
        """
        if self.flanks == "plain":
            return np.zeros_like(phi), np.zeros_like(phi)
        grid = np.linspace(0, self.reach, GAP_STEPS)
        front, back = self.free_gaps(grid, self.stroke)
        if self.flanks == "drawn":
            reliefs = [self.drawn_gap(grid) - front, self.drawn_gap(-grid) - back]
        elif self.flanks == "conjugate":
            reliefs = [front[0] - front, np.zeros_like(back)]
        else:
            reliefs = [np.maximum.accumulate(gap) - gap for gap in (front, back)]
        ahead, behind = (np.interp(np.abs(phi), grid, removed) for removed in reliefs)
        # the mirror of a front flank is the back flank on the other side
        return np.where(phi >= 0, ahead, behind), np.where(phi >= 0, behind, ahead)

    def drawn_gap(self, phi: np.ndarray) -> np.ndarray:
        """Of front flanks on the ideal rim [mm]; teeth that meet nowhere stand off by the stroke.

        A tooth turns in its space by φ (z2 − z1)/z2 and by the section's (v − w′)/R.
        """
        assert self.drawn is not None
        x = self.offset(phi) + self.shift(phi, self.stroke)
        y = self.stroke * (1 - np.cos(2 * phi))
        section = 1.5 * self.stroke * (1 + self.height) / self.pitch_radius * np.sin(2 * phi)
        gap = self.drawn.gap(x, y, phi * self.lag + section)
        return np.minimum(self.clearance / 2 + gap, self.stroke)

    @property
    def largest_relief(self) -> float:
        """Within reach [mm]."""
        return float(max(part.max() for part in self.relief(np.linspace(0, self.reach, GAP_STEPS))))

    @property
    def relieved_from(self) -> float:
        """φ [rad] of the largest gap of the plain front flank, beyond which it is relieved."""
        grid = np.linspace(0, self.reach, GAP_STEPS)
        return float(grid[self.free_gaps(grid, self.stroke)[0].argmax()])

    def stations(self, teeth: int, most: int) -> tuple[np.ndarray, float]:
        """Angles of the teeth within reach, one of them on the major axis, and teeth per station.

        With more than `most` teeth in half a turn, `most` stations stand for them.
        """
        count = min(teeth / 2, most)
        step = pi / count
        k = int(self.reach / step)
        return step * np.arange(-k, k + 1), teeth / 2 / count
