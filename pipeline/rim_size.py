"""The size of a flexspline's mesh for the lobe cases and the ellipse's picture, a quarter or half of it."""

from __future__ import annotations

from flexspline.geometry.symmetry import sector_of
from flexspline.pipeline.parts import PartModel

RIM_ELEMENTS = 25_000
"""About 110 000 unknowns and 5 s for each of the two lobe cases. On a thick hat with holes (wall of 1/13 of
the diameter) 92 790 gave K_b_lobes ± 0.07 % in half a minute, where 1 % was asked."""
HOLES_ALONE_ELEMENTS = 10_000
"""The same if the meshes only have to give the change caused by holes: K of a hat with ten holes is known to
± 0.011 and 0.014 % with 8 040 elements, to ± 0.010 and 0.013 % with 20 115, which take 0.6 s more of the
processor each."""


def copies_in_rim(model: PartModel) -> int:
    """Return how many of torsion's sectors make the lobes' and the ellipse's."""
    return round(sector_of(model.part, "ellipse").degrees / model.sector.degrees)


def fits_rim(model: PartModel, elements: int) -> bool:
    """Whether a mesh of torsion's sector is small enough for the lobe cases and the ellipse's picture.

    A shaft has none of them: in a sector larger than the ellipse's (no copies) any mesh is small enough.
    """
    return elements * copies_in_rim(model) <= _most_in_rim(model)


def most_in_sector(flexspline: PartModel) -> float:
    """Return the largest number of elements for which `fits_rim` is true."""
    return _most_in_rim(flexspline) / copies_in_rim(flexspline)


def _most_in_rim(model: PartModel) -> int:
    holes_alone = model.context.design.solver.model == "auto"
    return HOLES_ALONE_ELEMENTS if holes_alone else RIM_ELEMENTS
