"""The estimated error of an upper bound of K, scaled by what the last two meshes say of it.

The recovery estimate e of K's error is off by a factor c that the meshes' K tell: K_1 − c·e_1 = K_2 − c·e_2.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from flexspline.fea.types import MeshLevel


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
    estimates: list[float] = field(default_factory=list)
    """Relative, of each mesh's own K."""

    def add(self, level: MeshLevel, relative: float) -> None:
        """One more mesh."""
        self.levels.append(level)
        self.estimates.append(relative)

    @property
    def K_Nm_per_rad(self) -> float:
        """Of the finest mesh."""
        return self.levels[-1].K_Nm_per_rad

    @property
    def scale(self) -> float:
        """c, true over estimated error; the believed range's upper end where the estimate did not fall."""
        if len(self.levels) < 2:
            return self.usual
        before, last = (level.K_Nm_per_rad for level in self.levels[-2:])
        promised = self.estimates[-2] * before - self.estimates[-1] * last
        c = (before - last) / promised if promised > 0 else self.believed[1]
        return float(np.clip(c, *self.believed))

    @property
    def relative(self) -> float:
        """Error of the finest mesh's K over that K."""
        return self.scale * self.estimates[-1]
