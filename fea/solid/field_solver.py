"""The field that is solved on a part's solid meshes, and what a mesh tells of K by it."""

from __future__ import annotations

from typing import NamedTuple, Protocol, TypeVar

from flexspline.fea.scaled_estimate import MeshResult
from flexspline.fea.solid.load_cases import SolvedStiffness
from flexspline.fea.solid.model import Model
from flexspline.fea.types import Elastic, MeshLevel


class ErrorScales(NamedTuple):
    """c, the true over the estimated error of K.

    Attributes
    ----------
    usual : before two meshes can tell; the bounds hold for c up to twice it.
    believed : the range that two meshes may claim.
    by_error : that range on meshes that follow the error.
    """

    usual: float
    believed: tuple[float, float]
    by_error: tuple[float, float]


FULL_SCALES = ErrorScales(usual=2.0, believed=(1.5, 3.1), by_error=(2.5, 4.2))
"""Of all of a part's field. `usual` is the middle of those measured. `believed`: 1.5 to 2.8 on cups, hats and
shafts, swept and not, against two-sided bounds. `by_error`: 4.0 and 4.2 with 31 000 and 62 000 elements of a
shaft with three wide holes, against 128 000; its first two meshes told 2.0, and the bounds from that missed K
by 0.05 %."""
CORRECTION_SCALES = ErrorScales(usual=3.5, believed=(3.5, 6.5), by_error=(3.5, 6.5))
"""Of what holes change: 1.5 to 3.2 by the first two meshes of 22 random cups, hats and shafts, 5.1 and 6.3 on
two shafts. Two meshes may tell too little: of 13 holes 45 diameters deep they told 2.5, and the third, with
more elements about the holes, fell by four times as much. They are believed from the usual on."""


def by_correction(error: str) -> str:
    """How K is found where only what holes change is solved on meshes."""
    return (
        "the part without holes on its meridian, and what the holes change by solid meshes"
        f" (Bueckner's superposition); of that change, {error}"
    )


Result = TypeVar("Result", bound=MeshResult, covariant=True)


class FieldSolver(Protocol[Result]):
    """Of a load case.

    Attributes
    ----------
    scales : of its estimated errors.
    """

    material: Elastic
    scales: ErrorScales

    def solve(self, model: Model) -> Result:
        """On one mesh; raises SolidError, MemoryError."""

    def method(self, error: str) -> str:
        """How K is found, by what is said of its estimated error."""


def level_of(solved: SolvedStiffness) -> MeshLevel:
    """What one mesh gave."""
    return MeshLevel(
        shortest_edge_mm=solved.mesh.shortest_edge_mm,
        elements=len(solved.mesh.cells),
        dofs=solved.dofs,
        K_Nm_per_rad=solved.K_energy,
        K_check_Nm_per_rad=solved.K_check,
        residual=solved.residual,
    )
