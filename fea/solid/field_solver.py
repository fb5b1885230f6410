"""The solver of a field on a part's solid meshes, and the value of K from each mesh."""

from __future__ import annotations

from typing import NamedTuple, Protocol, TypeVar

import numpy as np

from flexspline.fea.scaled_estimate import MeshResult
from flexspline.fea.solid.bisectable import BisectableMesh
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.solved import SolvedCorrection
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.types import Elastic, TetMesh


class ErrorScales(NamedTuple):
    """c, the true over the estimated error of K.

    Attributes
    ----------
    usual, in_layers : before two meshes can tell, and that of a mesh in layers; the bounds hold for c up to
        twice it.
    believed : the range that two meshes may claim.
    by_error : that range on meshes that follow the error.
    """

    usual: float
    in_layers: float
    believed: tuple[float, float]
    by_error: tuple[float, float]

    def before_two(self, mesh: TetMesh) -> float:
        """The factor c if this is the only mesh."""
        in_layers = isinstance(mesh, BisectableMesh) and mesh.in_layers
        return self.in_layers if in_layers else self.usual


FULL_SCALES = ErrorScales(usual=2.0, in_layers=3.5, believed=(1.5, 3.1), by_error=(2.5, 4.2))
"""Of all of a part's field. `usual`: 1.5 to 3.4 on the first meshes of 68 random parts that were swept.
`in_layers`: 1.6 to 4.5 on those of 35 random shafts, 5.8, 6.1 and 7.3 on three more. `believed`: 1.5 to 2.8
on cups, hats and shafts, swept and not, against two-sided bounds. `by_error`: 4.0 and 4.2 with 31 000 and
62 000 elements of a shaft with three wide holes, against 128 000; its first two meshes told 2.0, and the
bounds from that missed K by 0.05 %."""
CORRECTION_SCALES = ErrorScales(usual=3.5, in_layers=3.5, believed=(3.5, 6.5), by_error=(3.5, 6.5))
"""Of what cuts change. Holes: 1.5 to 3.2 by the first two meshes of 22 random cups, hats and shafts, 5.1 and
6.3 on two shafts. Keyways: 2.0 to 4.8 on the first meshes of twelve random shafts, 6.5 on one. Two meshes
may tell too little: of 13 holes 45 diameters deep they told 2.5, and the third, with more elements about the
holes, fell by four times as much. They are believed from the usual on."""


def by_correction(cuts: str, error: str) -> str:
    """Describe how K is found if only the change by holes or a keyway is solved on meshes."""
    return (
        f"the part without {cuts} on its meridian, and the effect of the {cuts} by solid meshes"
        f" (Bueckner's superposition); of that effect, {error}"
    )


Result = TypeVar("Result", bound=MeshResult, covariant=True)


class FieldSolver(Protocol[Result]):
    """Solves a load case on a mesh.

    Attributes
    ----------
    scales : of its estimated errors.
    """

    material: Elastic
    scales: ErrorScales

    def solve(self, model: Model) -> Result:
        """Solve on one mesh; raises SolidError, MemoryError."""

    def method(self, error: str) -> str:
        """Describes how K is found; `error` describes its estimated error."""


def error_of(correction: SolvedCorrection, material: Elastic) -> tuple[np.ndarray, float]:
    """Return the estimated error of a(v_h, v_h) of each element (m,), and of the whole part [N·mm]."""
    error = energy_error(correction.mesh, correction.displacement, material).error
    return error, float(error.sum() * 360 / correction.mesh.sector_deg)
