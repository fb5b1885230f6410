"""How far sharp edges and patch edges reach in the stress rule: a length of each part's own."""

from __future__ import annotations

from flexspline.geometry.design import Cup, Hat, Shaft

SHARE_OF_RADIUS = 1 / 20
"""Of the shaft's least outer radius. A shaft's wall is often most of its radius; one such wall from every
edge would leave out its fillets, which count in full. What a rigid grip adds at its edge has died out by a
small share of the radius: at 1/20 the peaks of the examples' shafts lie in their fillets, at 1/45 at the
grip."""


def exclusion_mm(part: Cup | Hat | Shaft) -> float:
    """Points nearer than this to a sharp edge or a patch edge count for no peak stress [mm].

    One wall thickness: the flexspline's `wall_thickness_mm`; the shaft's thinnest wall, and at most
    SHARE_OF_RADIUS of its least outer radius.
    """
    if not isinstance(part, Shaft):
        return part.wall_thickness_mm
    walls = [(s.outer_diameter_mm - s.inner_diameter_mm) / 2 for s in part.segment]
    radius = min(s.outer_diameter_mm for s in part.segment) / 2
    return min(*walls, SHARE_OF_RADIUS * radius)
