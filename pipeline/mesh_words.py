"""What is said of a solid part's meshes: how long a large one takes, and what tells K closer."""

from __future__ import annotations

from flexspline.pipeline.parts import PartModel


def remedy(model: PartModel) -> str:
    """What tells K closer, where the last mesh does not meet the tolerance."""
    part, by_name = model.part, model.context.design.solver.model == "solid"
    if by_name and not part.cuts_meet:
        alone = f", and only what its {part.cuts} change on such meshes" if part.cuts else ""
        return (
            f'solver.model = "auto" tells K closer: it solves the {part.name} on a meridian{alone}'
        )
    if model.states_edges:
        return "without solver.edge_length_mm there is time for more meshes"
    return "raise solver.tolerance_pct"
