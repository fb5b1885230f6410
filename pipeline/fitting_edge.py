"""A `solver.edge_length_mm` that is possible, if the design's value leads to too many elements."""

from __future__ import annotations

from math import ceil, floor, log10

from flexspline.fea.errors import SolidError, TooManyElementsError
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.swept_sizing import MOST_ELEMENTS
from flexspline.geometry.part import Part
from flexspline.geometry.symmetry import Sector

TRIED_ELEMENTS, TRIES = 60_000, 5
"""Of the mesh from which the edge is told, at least, and how many meshes are made for it: 1 to 2 s each."""
FITTING_ELEMENTS = MOST_ELEMENTS / 2
"""That the edge asks for, if elements grow with the third power of 1/edge: half of what is made, as they grow
in steps, by three times from edges of 1 to 0.8 mm in a keyed shaft with holes."""


class StatedEdgeError(SolidError):
    """The stated edges `edge_mm` ask for too many `elements` of a part; `fits_mm`, if known, does not."""

    def __init__(self, part: str, edge_mm: float, elements: float, fits_mm: float | None) -> None:
        self.edge_mm, self.elements, self.fits_mm = edge_mm, elements, fits_mm
        longer = "a longer one is needed" if fits_mm is None else f"{fits_mm:g} fits"
        super().__init__(
            f"solver.edge_length_mm = {edge_mm:g} asks for {elements:.0f} elements of the {part} or more, "
            f"and no mesh of more than {MOST_ELEMENTS} is made; {longer}"
        )


def fitting_edge_mm(part: Part, sector: Sector, stated_mm: float) -> float | None:
    """Return the edge length that fits, to two digits; None where no mesh tells it."""
    edge = first_spec(part).grading.far
    fits = None
    for _ in range(TRIES):
        try:
            mesh = swept_mesh(part, sector.degrees, first_spec(part, edge))
        except TooManyElementsError:
            break
        if mesh is None:
            break
        fits = edge * (mesh.elements / FITTING_ELEMENTS) ** (1 / 3)
        if mesh.elements >= TRIED_ELEMENTS:
            break
        edge *= (mesh.elements / (2 * TRIED_ELEMENTS)) ** (1 / 3)
    return None if fits is None or fits <= stated_mm else _rounded_up(fits)


def _rounded_up(value: float) -> float:
    unit = 10.0 ** (floor(log10(value)) - 1)
    return float(f"{ceil(value / unit) * unit:.2g}")
