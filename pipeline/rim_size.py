"""The size of a flexspline's mesh for the lobe cases and the ellipse's picture, a quarter or half of it."""

from __future__ import annotations

from flexspline.geometry.symmetry import sector_of
from flexspline.pipeline.parts import PartModel

RIM_ELEMENTS = 25_000
"""About 110 000 unknowns and 5 s for each of the two lobe cases. On a thick hat with holes (wall of 1/13 of
the diameter) 92 790 gave K_b_lobes ± 0.07 % in half a minute, where 1 % was asked."""
HOLES_ALONE_ELEMENTS = 10_000
"""The same where the meshes need only tell what holes change: a hat with ten holes is known to ± 0.011 and
0.014 % by 8 040 elements, to ± 0.010 and 0.013 % by 20 115, for 0.6 s less of the processor each."""


def copies_in_rim(model: PartModel) -> int:
    """How many of torsion's sectors make the lobes' and the ellipse's."""
    return round(sector_of(model.part, "ellipse").degrees / model.sector.degrees)


def most_in_sector(model: PartModel) -> float:
    """Elements of torsion's sector at most, so that the lobe cases' and the ellipse's picture stay small."""
    holes_alone = model.context.design.solver.model == "auto"
    most = HOLES_ALONE_ELEMENTS if holes_alone else RIM_ELEMENTS
    return most / copies_in_rim(model)
