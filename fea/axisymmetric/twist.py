"""A solved torsion field of a body of revolution, stored so that it can be used for another shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.harmonics import Fixed, Harmonic, HarmonicModel
from flexspline.fea.axisymmetric.lobes import LOBE_BULK
from flexspline.fea.axisymmetric.marking import MOST_TRIANGLES, bulk
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.recovery import recovered
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.cylindrical import TANGENTIAL
from flexspline.fea.refinement import refine
from flexspline.fea.shortfall import ToleranceError
from flexspline.fea.types import NMM_PER_NM, Elastic
from flexspline.geometry.outline import Meridian

TWIST = Harmonic(0, torsion=True)


@dataclass(frozen=True)
class Twist:
    """A solved torsion problem, ready to be moved.

    `rotation` (count,): ψ [rad] at the P2 nodes, 0 where r = 0; `K_Nm_per_rad` from above.
    """

    mesh: MeridianMesh
    material: Elastic
    rotation: np.ndarray
    K_Nm_per_rad: float


def twist(outline: Meridian, material: Elastic, driven: str, relative_error: float) -> Twist:
    """Solve torsion; refine until the estimated relative error of K is below `relative_error`.

    Raises
    ------
    MeshingError, HarmonicError, ToleranceError
    """
    finest = _TwistRefinement(material, driven, relative_error)
    if why := refine(finest, triangulate(outline), most_elements=MOST_TRIANGLES):
        raise ToleranceError(f"the energy is off by {finest.error:.2g}", why)
    r = finest.model.space.places[:, 0]
    turned = finest.solved.values.reshape(-1, 3)[:, TANGENTIAL]
    rotation = np.divide(turned, r, out=np.zeros_like(turned), where=r > 0)
    return Twist(finest.model.mesh, material, rotation, finest.solved.twice_energy / NMM_PER_NM)


class _TwistRefinement:
    """The finest mesh's solution, and its estimated relative error of the energy."""

    def __init__(self, material: Elastic, driven: str, relative_error: float) -> None:
        self._material, self._driven, self._relative_error = material, driven, relative_error

    def solve(self, mesh: MeridianMesh) -> None:
        model = HarmonicModel(mesh, self._material)
        on = model.on(self._driven)
        fixed = [Fixed(on, TANGENTIAL, model.space.places[on, 0]), *model.held("mount")]
        solved = model.solve(TWIST, fixed, np.zeros(3 * model.space.count))
        recovery = recovered(model, TWIST, solved.values)
        self.model, self.solved, self._recovery = model, solved, recovery

    @property
    def error(self) -> float:
        return float(self._recovery.error.sum() / self._recovery.energy.sum())

    @property
    def met(self) -> bool:
        return self.error < self._relative_error

    def finer(self, mesh: MeridianMesh) -> MeridianMesh:
        return refined(mesh, bulk(self._recovery.error, LOBE_BULK))
