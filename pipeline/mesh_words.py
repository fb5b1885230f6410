"""Messages about a solid part's meshes: the time for a large one, and how to tighten the bounds of K."""

from __future__ import annotations

from flexspline.pipeline.parts import PartModel

LONG_ELEMENTS = 60_000
"""From which the solution of a mesh is announced, with its time."""
SECONDS_PER_ELEMENT = 2e-4
"""Of torsion on a large mesh: 21 and 27 s of the processor for 183 000 and 161 000 elements of two shafts, 64
s for 335 000 of the second."""


def long_solve(model: PartModel, elements: int) -> str:
    """Return a line to print before a solve that takes long; else ""."""
    if elements < LONG_ELEMENTS:
        return ""
    edge = model.context.design.solver.edge_length_mm
    why = "" if edge is None else f" by solver.edge_length_mm = {edge:g}"
    return f"{elements} elements{why}: solved in about {elements * SECONDS_PER_ELEMENT:.0f} s"


def remedy(model: PartModel) -> str:
    """Return how to tighten the bounds of K if the last mesh does not meet the tolerance."""
    part, by_name = model.part, model.context.design.solver.model == "solid"
    if by_name and not part.cuts_meet:
        alone = f", and on such meshes only the effect of its {part.cuts}" if part.cuts else ""
        return (
            'solver.model = "auto" gives tighter bounds of K: it solves the '
            f"{part.name} on a meridian{alone}"
        )
    if model.states_edges:
        return "without solver.edge_length_mm there is time for more meshes"
    return "raise solver.tolerance_pct"
