"""The estimated error of an upper bound of K, scaled by what the last two meshes say of it.

The recovery estimate e of K's error is off by a factor c that the meshes' K tell: K_1 − c·e_1 = K_2 − c·e_2.
On meshes that follow e, what e does not see stays: there K's own falls are asked, too. If each is q times the
one before, K_1 − K_2 = d leaves d·q/(1 − q).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from flexspline.fea.types import MeshLevel

ERROR_RATIOS = (0.6, 0.75)
"""q of meshes of twice the elements each: 0.59 and 0.72 on a sharply stepped shaft with ten holes, meshed
evenly to 65 000 elements. The bounds hold to twice what is left: for q up to 0.86."""


class EstimatedBounds(NamedTuple):
    """K with the finest mesh's above it and an estimate below it, twice as far off [N·m/rad]."""

    K: float
    lower: float
    upper: float

    @property
    def half(self) -> float:
        """Half of their distance over K."""
        return (self.upper - self.lower) / (2 * self.K)


@dataclass
class ScaledEstimate:
    """K and its estimated errors of meshes, coarse to fine.

    Attributes
    ----------
    usual : c as long as there is one mesh.
    believed : the range that two meshes may claim.
    """

    usual: float
    believed: tuple[float, float]
    levels: list[MeshLevel] = field(default_factory=list)
    falls: tuple[float, float] | None = None
    """The range of q where each mesh follows the errors of the one before and has twice its elements."""
    estimates: list[float] = field(default_factory=list)
    """Relative, of each mesh's own K."""
    found: list[float] = field(default_factory=list)
    """K by each mesh [N·m/rad]: its own, or a better one that is above K too."""
    doubt: float = 0.0
    """Relative, to both sides, of the last of these K: what no finer mesh takes away."""

    def add(
        self,
        level: MeshLevel,
        relative: float,
        K_Nm_per_rad: float | None = None,
        doubt: float = 0.0,
    ) -> None:
        """One more mesh; `relative`, the estimate, is of `K_Nm_per_rad` where the mesh's own is not used."""
        self.levels.append(level)
        self.estimates.append(relative)
        self.found.append(level.K_Nm_per_rad if K_Nm_per_rad is None else K_Nm_per_rad)
        self.doubt = doubt

    @property
    def K_Nm_per_rad(self) -> float:
        """By the finest mesh."""
        return self.found[-1]

    @property
    def scale(self) -> float:
        """c, true over estimated error; the believed range's upper end where the estimate did not fall, and
        as much more as K's falls tell."""
        if len(self.levels) < 2:
            return self.usual
        before, last = self.found[-2:]
        promised = self.estimates[-2] * before - self.estimates[-1] * last
        c = (before - last) / promised if promised > 0 else self.believed[1]
        return max(float(np.clip(c, *self.believed)), self._left / self.estimates[-1])

    @property
    def _left(self) -> float:
        """Error of the finest mesh's K over that K by K's last two falls; 0 where they are not asked."""
        if self.falls is None or len(self.levels) < 3:
            return 0.0
        K = self.found[-3:]
        before, last = K[0] - K[1], K[1] - K[2]
        q = float(np.clip(last / before, *self.falls)) if before > 0 else self.falls[1]
        return last * q / (1 - q) / K[-1]

    @property
    def relative(self) -> float:
        """Error of the finest mesh's energy over that energy."""
        return self.scale * self.estimates[-1]

    def at_given_angle(self) -> EstimatedBounds:
        """Of a K that is proportional to the energy: a mesh stores too much of it."""
        K, error, doubt = self.K_Nm_per_rad, self.relative, self.doubt
        return EstimatedBounds(K * (1 - error), K * (1 - 2 * error - doubt), K * (1 + doubt))

    def at_given_torque(self, missing: float = 0.0) -> EstimatedBounds:
        """Of a 1/K that is proportional to the energy: a mesh stores too little of it.

        `missing` bounds, relative, what it lacks besides, such as load that is left out.
        """
        K, error, doubt = self.K_Nm_per_rad, self.relative, self.doubt
        lower = K / (1 + 2 * error + missing + doubt)
        return EstimatedBounds(K / (1 + error + missing / 2), lower, K / (1 - doubt))
