"""The estimated error of an upper bound of K, scaled by the change between the last two meshes.

The recovery estimate e of K's error is off by a factor c that the meshes' K tell: K_1 − c·e_1 = K_2 − c·e_2.
On meshes that follow e, what e does not see stays: there K's own falls are asked, too. If each is q times the
one before, K_1 − K_2 = d leaves d·q/(1 − q).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from flexspline.fea.types import MeshLevel, Shortfall, Stiffness, StiffnessModel

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
        """Return half of their distance over K."""
        return (self.upper - self.lower) / (2 * self.K)


@dataclass(frozen=True)
class MeshResult:
    """One mesh's K, which is an upper bound but for `doubt`.

    Attributes
    ----------
    level : the mesh, with the K that it gives.
    error : estimated, of that K, over it.
    doubt : of K, over it, to both sides: what no finer mesh takes away.
    """

    level: MeshLevel
    error: float
    doubt: float = 0.0

    @property
    def K_Nm_per_rad(self) -> float:
        """K that the mesh gives."""
        return self.level.K_Nm_per_rad


@dataclass(frozen=True)
class ScaledEstimate:
    """K and its estimated errors on a sequence of meshes, coarse to fine.

    Attributes
    ----------
    usual : c as long as there is one mesh.
    believed : the range that two meshes may claim.
    """

    usual: float
    believed: tuple[float, float]
    meshes: tuple[MeshResult, ...] = ()
    falls: tuple[float, float] | None = None
    """The range of q where each mesh follows the errors of the one before and has twice its elements."""

    def with_mesh(self, result: MeshResult) -> ScaledEstimate:
        """Return a copy with the result of one more mesh."""
        return replace(self, meshes=(*self.meshes, result))

    @property
    def levels(self) -> tuple[MeshLevel, ...]:
        """The meshes, coarse to fine, with their K."""
        return tuple(m.level for m in self.meshes)

    @property
    def K_Nm_per_rad(self) -> float:
        """K of the finest mesh."""
        return self.meshes[-1].K_Nm_per_rad

    @property
    def scale(self) -> float:
        """c, true over estimated error; the believed range's upper end where the estimate did not fall, and
        as much more as K's falls tell."""
        if len(self.meshes) < 2:
            return self.usual
        before, last = self.meshes[-2:]
        promised = before.error * before.K_Nm_per_rad - last.error * last.K_Nm_per_rad
        fell = before.K_Nm_per_rad - last.K_Nm_per_rad
        c = fell / promised if promised > 0 else self.believed[1]
        return max(float(np.clip(c, *self.believed)), self._left / last.error)

    @property
    def _left(self) -> float:
        """Error of the finest mesh's K over that K by K's last two falls; 0 where they are not asked."""
        if self.falls is None or len(self.meshes) < 3:
            return 0.0
        K = [m.K_Nm_per_rad for m in self.meshes[-3:]]
        before, last = K[0] - K[1], K[1] - K[2]
        q = float(np.clip(last / before, *self.falls)) if before > 0 else self.falls[1]
        return last * q / (1 - q) / K[-1]

    @property
    def relative(self) -> float:
        """Error of the finest mesh's energy over that energy."""
        return self.scale * self.meshes[-1].error

    def at_given_angle(self) -> EstimatedBounds:
        """Return the bounds of a K that is proportional to the energy: a mesh stores too much energy."""
        K, error, doubt = self.K_Nm_per_rad, self.relative, self.meshes[-1].doubt
        return EstimatedBounds(K * (1 - error), K * (1 - 2 * error - doubt), K * (1 + doubt))

    def at_given_torque(self, missing: float = 0.0) -> EstimatedBounds:
        """Return the bounds where 1/K is proportional to the energy: a mesh stores too little energy.

        `missing` bounds, relative, what it lacks besides, such as load that is left out.
        """
        K, error, doubt = self.K_Nm_per_rad, self.relative, self.meshes[-1].doubt
        lower = K / (1 + 2 * error + missing + doubt)
        return EstimatedBounds(K / (1 + error + missing / 2), lower, K / (1 - doubt))

    def stiffness(
        self,
        bounds: EstimatedBounds,
        model: StiffnessModel,
        symmetry: str,
        method: str,
        shortfall: Shortfall,
    ) -> Stiffness:
        """Return the stiffness with these bounds. They are estimates: curved edges only follow fillets."""
        return Stiffness(
            K_Nm_per_rad=bounds.K,
            lower_Nm_per_rad=bounds.lower,
            upper_Nm_per_rad=bounds.upper,
            guaranteed=False,
            model=model,
            symmetry=symmetry,
            method=method,
            levels=self.levels,
            error_scale=self.scale,
            shortfall=shortfall,
        )
